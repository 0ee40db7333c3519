#include "results/document/document_json.hpp"

#include <nlohmann/json.hpp>

#include "results/text/number_json.hpp"

namespace mpm {

std::string document_json(const Document& document) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const Section& section : document.sections)
    if (section.data)
      section.data(json);
  return json_text(json);
}

}  // namespace mpm
