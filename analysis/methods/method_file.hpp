#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace mpm {

/// The rule for the name of a method that somebody else has made, wherever the name comes from: it is part of
/// option values, file names, tables and pages. Words that stand for something else where a name may stand
/// are taken.
inline constexpr const char* kMethodNameRule =
    "a name of 1 to 64 letters (a to z), digits, '-' and '_', without '-' at its beginning, and not all, "
    "experiments, findings or loops";

bool is_method_name(std::string_view name);
/// The same of a method that has answered, which may be a variant or a composite of methods: NAME:END,
/// NAME+NAME.
bool is_answering_name(std::string_view name);

/// A method of a file of methods: a program of its own (analysis/methods/outside_program), or two methods as
/// one (analysis/methods/composite_method).
struct MethodProgram {
  std::string name;                       ///< of the method
  std::string detector = {}, namer = {};  ///< the methods of a composite; empty: it is a program
  std::vector<std::string> command = {};  ///< the program and its arguments
  double time_limit = 60.0;               ///< seconds for an answer
  std::string options = "{}";             ///< JSON, for the program
  /// The option among these that scores are compared with (threshold_rule.hpp); empty: none is known to be.
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
