#include "scenarios/toml_file.hpp"

#include <fstream>

#include "plants/error.hpp"
#include "plants/input_file.hpp"
#include "scenarios/toml_text.hpp"

namespace mpm {

std::string read_toml_file(const std::filesystem::path& path, const std::string& allowed) {
  std::ifstream file = open_input(path, allowed);
  std::string text(kMaxTomlBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad() || (file.gcount() == 0 && !file.eof()))
    throw InputError(path.string(), "a file that cannot be read to its end", allowed);
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

}  // namespace mpm
