#pragma once

#include <string>
#include <string_view>

#include "plants/outside/fmu_package.hpp"

namespace mpm {

/// The library of an FMU, and the messages of its one instance in this process.
class FmuLibrary {
 public:
  /// Loads the library. Names that this program has as well, such as those of CVODE and LAPACK, are looked up
  /// in the library first. `prefix` stands before the names of all functions. Errors: ForeignFailure if the
  /// library cannot be loaded or has another version of the interface than `version`.
  FmuLibrary(const FmuPackage& package, std::string prefix, std::string_view version);

  template <class Function>
  Function* function(const std::string& name) const {
    return reinterpret_cast<Function*>(symbol(name));
  }
  /// Throws ForeignFailure unless the function of this name, which takes no arguments, returns this text.
  void require_text(const std::string& name, std::string_view text) const;
  /// Throws ForeignFailure unless the status is `ok` or `warning`; both versions number them alike.
  void require(int status, const std::string& function, double now) const;
  /// Throws ForeignFailure if the FMU asks to end.
  void require_no_end(bool asks, const std::string& function, double now) const;
  /// Returns " (it says: ...)" with the last message of trouble, or the last message if there was no trouble;
  /// empty if there is none.
  static std::string said();
  static void keep(int status, const char* message);

 private:
  void* symbol(const std::string& name) const;

  std::string prefix_;
  void* library_;
};

}  // namespace mpm
