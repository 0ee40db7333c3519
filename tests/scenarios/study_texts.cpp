#include "tests/scenarios/study_texts.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "analysis/study_files/study_file.hpp"
#include "base/error.hpp"

namespace mpm::testing {

std::string project_file(const std::string& path) {
  std::ifstream file(std::string(MPMBENCH_SOURCE_DIR) + "/" + path, std::ios::binary);
  if (!file) {
    throw std::logic_error("no file " + path);
  }
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string small_study() {
  return project_file("tests/scenarios/data/small.toml");
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t place = text.find(from);
  if (place == std::string::npos) {
    throw std::logic_error("the text has no '" + from + "'");
  }
  return text.replace(place, from.size(), to);
}

std::size_t line_of(const std::string& text, const std::string& part) {
  const std::size_t place = text.find(part);
  if (place == std::string::npos) {
    throw std::logic_error("the text has no '" + part + "'");
  }
  const auto begin = text.begin();
  return 1 + static_cast<std::size_t>(std::count(begin, begin + static_cast<std::ptrdiff_t>(place), '\n'));
}

std::string refusal(const std::string& text) {
  try {
    parse_study(text, "s.toml");
    return "accepted";
  } catch (const InputError& error) {
    return error.what();
  }
}

void check_refusals(const std::vector<Refusal>& refusals) {
  const std::string small = small_study();
  for (const Refusal& refused : refusals) {
    const std::string text =
        refused.from.empty() ? small + refused.to : replaced(small, refused.from, refused.to);
    CHECK(refusal(text) == fmt::format("s.toml:{}: {}", line_of(text, refused.marker), refused.message));
  }
}

}  // namespace mpm::testing
