#include "analysis/identification/identification.hpp"

namespace mpm {

bool is_usable(IdentificationStatus status) {
  return status == IdentificationStatus::ok || status == IdentificationStatus::noise_free ||
         status == IdentificationStatus::at_stability_limit;
}

std::string to_string(IdentificationStatus status) {
  switch (status) {
    case IdentificationStatus::ok:
      return "ok";
    case IdentificationStatus::rank_deficient:
      return "rank deficient";
    case IdentificationStatus::not_converged:
      return "not converged";
    case IdentificationStatus::at_stability_limit:
      return "at the stability limit";
    case IdentificationStatus::noise_free:
      break;
  }
  return "noise free";
}

}  // namespace mpm
