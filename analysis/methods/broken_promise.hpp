#pragma once

#include "base/error.hpp"

namespace mpm {

/// An outside method does not keep what its file says about it. This error ends every command; any other
/// InputError of a method that learns or assesses becomes a verdict with the status `failed`.
class BrokenPromise : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace mpm
