#pragma once

#include "base/error.hpp"

namespace mpm {

/// An option of a method that does not fit the study or its benchmark. It is wrong input, and ends the
/// command; any other InputError of a method that learns or assesses is a verdict that failed.
class UnfitOption : public InputError {
 public:
  using InputError::InputError;
};

/// A method from outside that is not what its file says of it. It ends every command, also one that goes on
/// with other studies after an option that does not fit.
class BrokenPromise : public UnfitOption {
 public:
  using UnfitOption::UnfitOption;
};

}  // namespace mpm
