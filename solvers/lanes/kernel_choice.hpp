#pragma once

#include <vector>

#include "solvers/lanes/lane_kernels.hpp"

namespace mpm {

/// The kernels that this program uses: the last of lane_kernel_sets(), or those that the environment variable
/// MPMBENCH_KERNELS names. Throws InputError when it names none of them.
const LaneKernels& lane_kernels();

/// The sets of kernels that this processor can run, the fastest last.
std::vector<const LaneKernels*> lane_kernel_sets();

}  // namespace mpm
