#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace mpm::testing {

/// The text of tests/scenarios/data/small.toml, a study of 2 CVs, 2 MVs and 1 MD without optional keys.
std::string small_study();

/// The text of a file below the root of the repository.
std::string project_file(const std::string& path);

/// `text` with its first `from` replaced by `to`. Throws std::logic_error when `from` is not there, so that
/// no test passes on an unchanged text.
std::string replaced(std::string text, const std::string& from, const std::string& to);

/// Number of the line in which the first `part` of `text` begins, counted from 1.
std::size_t line_of(const std::string& text, const std::string& part);

/// The message by which parse_study() refuses `text` under the file name "s.toml"; "accepted" when it does
/// not.
std::string refusal(const std::string& text);

/// One change of the small study and the message that it must bring.
struct Refusal {
  std::string from;     ///< text of the small study, first place; empty: `to` is added at the end
  std::string to;       ///< what stands there instead
  std::string marker;   ///< the message names the line on which this first begins in the changed text
  std::string message;  ///< what follows "s.toml:LINE: "
};

/// Checks each change on its own, the whole message to the letter.
void check_refusals(const std::vector<Refusal>& refusals);

}  // namespace mpm::testing
