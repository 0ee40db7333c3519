#pragma once

#include <string>

namespace mpm {

/// Version of mpmbench, e.g. "0.1.0".
std::string mpmbench_version();

/// Commit that the source was configured from, with "+" after it when the tree had changes; "unknown" outside
/// git.
std::string source_revision();

/// The libraries that numbers depend on, and the compiler, as the build has found them.
std::string library_versions();

}  // namespace mpm
