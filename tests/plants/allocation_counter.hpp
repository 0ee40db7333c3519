#pragma once

#include <cstddef>

/// Number of allocations of this program so far, through operator new, malloc, calloc or realloc (Eigen uses
/// malloc). Calls made inside shared libraries are not seen; those of headers and static libraries are.
std::size_t allocation_count();
