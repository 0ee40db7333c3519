#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace mpm {

/// The rule for the name of a method that somebody else has made, wherever the name comes from. The name
/// becomes part of option values, file names, tables and pages. Words that have another meaning in the place
/// of a name are refused.
inline constexpr const char* kMethodNameRule =
    "a name of 1 to 64 letters (a to z), digits, '-' and '_', without '-' at its beginning, and not all, "
    "experiments, findings or loops";

bool is_method_name(std::string_view name);
/// The same for the name of a method that has answered. It may be a variant or a composite of methods:
/// NAME:END, NAME+NAME.
bool is_answering_name(std::string_view name);

/// A method from a file of methods: a program of its own (analysis/methods/outside_program), or two methods
/// combined into one (analysis/methods/composite_method).
struct MethodProgram {
  std::string name;                       ///< name of the method
  std::string detector = {}, namer = {};  ///< the two methods of a composite; empty for a program
  std::vector<std::string> command = {};  ///< the program and its arguments
  double time_limit = 60.0;               ///< seconds to wait for an answer
  std::string options = "{}";             ///< JSON, for the program
  /// The option among these with which scores are compared (threshold_rule.hpp); empty if no such option is
  /// known.
  std::string threshold_option = {};
};

/// Reads a file of methods (docs/bring_your_own.md):
///
///   [method.mine]
///   command = ["python3", "mine.py"]
///   time_limit = 60
///   options = {threshold = 1.5}
///   threshold_option = "threshold"
///
///   [method.two]
///   detector = "sse"
///   namer = "lasso"
///
/// Errors: InputError "FILE:LINE: KEY: found ...; allowed: ..." as for a study file.
std::vector<MethodProgram> load_method_file(const std::filesystem::path& path);

}  // namespace mpm
