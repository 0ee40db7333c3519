#pragma once

#include <string>

#include "results/document/document.hpp"

namespace mpm {

/// Returns the data of all sections of the document as one JSON object. A number that is missing or infinite
/// is null.
std::string document_json(const Document& document);

}  // namespace mpm
