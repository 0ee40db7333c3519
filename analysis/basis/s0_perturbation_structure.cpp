#include "analysis/basis/s0_perturbation_structure.hpp"

#include <algorithm>

#include "analysis/sensitivity/s0_perturbation.hpp"

namespace mpm {

std::vector<StructureFit> structure_fits(const Study& study, const BasisCase& basis) {
  std::vector<StructureFit> fits;
  if (!basis.sensitivity_fixed)
    return fits;
  const double Ts = study.controller.sample_time;
  const std::vector<DiagonalFit> available = diagonal_fits(basis.sensitivity, Ts);
  for (const DiagonalFit& fixed : diagonal_fits(*basis.sensitivity_fixed, Ts)) {
    const auto same = std::find_if(available.begin(), available.end(),
                                   [&fixed](const DiagonalFit& fit) { return fit.cv == fixed.cv; });
    if (same == available.end())
      continue;
    const SecondOrderModel& from = same->fit.model;
    const SecondOrderModel& to = fixed.fit.model;
    fits.push_back(
        {fixed.cv, same->fit, fixed.fit, to.time_constant / from.time_constant, to.damping / from.damping});
  }
  return fits;
}

}  // namespace mpm
