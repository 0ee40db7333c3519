#pragma once

#include <stdexcept>

namespace mpm {

/// Thrown if an archive cannot be written or read. The text names the file, the object in it, and what is
/// wrong.
class ArchiveError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace mpm
