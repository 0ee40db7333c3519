#pragma once

#include <stdexcept>

namespace mpm {

/// An archive that cannot be written or read: the text names the file, the object in it, and what is wrong.
class ArchiveError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace mpm
