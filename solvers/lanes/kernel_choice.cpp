#include "solvers/lanes/kernel_choice.hpp"

#include <cstdlib>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"

namespace mpm {

// Each set is in a source of its own, which is compiled for its instructions.
extern const LaneKernels kBaselineKernels;
#ifdef MPMBENCH_X86_KERNELS
extern const LaneKernels kAvx2Kernels;
extern const LaneKernels kAvx512Kernels;
#endif

namespace {

const LaneKernels& choose() {
  const std::vector<const LaneKernels*> sets = lane_kernel_sets();
  const char* wanted = std::getenv("MPMBENCH_KERNELS");
  if (wanted == nullptr)
    return *sets.back();
  std::vector<std::string_view> names;
  for (const LaneKernels* set : sets) {
    if (std::string_view(wanted) == set->name)
      return *set;
    names.emplace_back(set->name);
  }
  throw InputError("environment variable MPMBENCH_KERNELS", fmt::format("\"{}\"", wanted),
                   fmt::format("{} (what this processor can run)", fmt::join(names, ", ")));
}

}  // namespace

const LaneKernels& lane_kernels() {
  static const LaneKernels& chosen = choose();
  return chosen;
}

std::vector<const LaneKernels*> lane_kernel_sets() {
  std::vector<const LaneKernels*> sets{&kBaselineKernels};
#ifdef MPMBENCH_X86_KERNELS
  for (const LaneKernels* set : {&kAvx2Kernels, &kAvx512Kernels})
    if (set->runs_here())
      sets.push_back(set);
#endif
  return sets;
}

}  // namespace mpm
