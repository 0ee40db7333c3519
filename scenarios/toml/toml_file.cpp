#include "scenarios/toml/toml_file.hpp"

#include <fstream>

#include "base/error.hpp"
#include "base/system/input_file.hpp"
#include "scenarios/toml/toml_text.hpp"

namespace mpm {

std::string read_toml_file(const std::filesystem::path& path, const std::string& allowed) {
  std::ifstream file = open_input(path, allowed);
  return read_toml_stream(file, path.string(), allowed);
}

std::string read_toml_stream(std::istream& stream, const std::string& name, const std::string& allowed) {
  std::string text(kMaxTomlBytes + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad() || (stream.gcount() == 0 && !stream.eof()))
    throw InputError(name, "a file that cannot be read to its end", allowed);
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

}  // namespace mpm
