#pragma once

#include <stdexcept>
#include <string>

namespace mpm {

/// Bad input: the text names the quantity, what was found and what is allowed.
///
/// Numerical outcomes (an infeasible problem, an iteration limit) are statuses in a result, never an
/// InputError.
class InputError : public std::invalid_argument {
 public:
  /// Text: "`quantity`: found `found`; allowed: `allowed`".
  InputError(const std::string& quantity, const std::string& found, const std::string& allowed)
      : std::invalid_argument(quantity + ": found " + found + "; allowed: " + allowed) {}

  /// A text that already has these parts.
  explicit InputError(const std::string& text) : std::invalid_argument(text) {}
};

/// An input under which a plant has no steady state. If it comes from a model or a study, it is bad input. If
/// a closed loop begins where its plant cannot rest, the loop has failed instead (run_closed_loop()).
class NoSteadyState : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace mpm
