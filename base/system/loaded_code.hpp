#pragma once

#include <string>

namespace mpm {

/// Returns a text that is the same only if the processor and all shared objects that this process has loaded
/// are the same: they decide the last bits of the results of Ipopt and of the mathematical functions. An
/// object is identified by the build identifier that its linker has put into it or, if it has none, by path,
/// size and time of change.
std::string loaded_code();

}  // namespace mpm
