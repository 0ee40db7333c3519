#pragma once

#include <string>

namespace mpm {

/// A text that is the same only where every shared object that this process has loaded is the same, and the
/// processor that runs it: they decide the last bits of Ipopt and of the mathematical functions. Objects are
/// known by the build identifier that their linker has put into them, and without one by path, size and time
/// of change.
std::string loaded_code();

}  // namespace mpm
