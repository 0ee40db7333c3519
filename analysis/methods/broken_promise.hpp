#pragma once

#include "base/error.hpp"

namespace mpm {

/// A method from outside that is not what its file says about it. It ends every command; any other InputError
/// of a method that learns or assesses is a verdict that failed.
class BrokenPromise : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace mpm
