#pragma once

#include <string>
#include <string_view>

#include "plants/outside/fmu_package.hpp"

namespace mpm {

/// The library of an FMU, and what its one instance in this process says.
class FmuLibrary {
 public:
  /// Names that this program has as well, such as those of CVODE and LAPACK, are first looked for in its own
  /// library. `prefix` stands before the names of all functions. Errors: ForeignFailure for a library that
  /// cannot be loaded or has another version of the interface than `version`.
  FmuLibrary(const FmuPackage& package, std::string prefix, std::string_view version);

  template <class Function>
  Function* function(const std::string& name) const {
    return reinterpret_cast<Function*>(symbol(name));
  }
  /// Throws ForeignFailure unless the function of this name, which takes nothing, gives this text.
  void require_text(const std::string& name, std::string_view text) const;
  /// Throws ForeignFailure unless the status is `ok` or `warning`; both versions number them alike.
  void require(int status, const std::string& function, double now) const;
  /// Throws ForeignFailure where the FMU asks to end.
  void require_no_end(bool asks, const std::string& function, double now) const;
  /// " (it says: ...)", its last message of trouble; empty: none.
  static std::string said();
  static void keep(int status, const char* message);

 private:
  void* symbol(const std::string& name) const;

  std::string prefix_;
  void* library_;
};

}  // namespace mpm
