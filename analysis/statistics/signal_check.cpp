#include "analysis/statistics/signal_check.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {

void require_signal(const std::string& name, const Eigen::Ref<const Eigen::VectorXd>& signal,
                    Eigen::Index shortest) {
  if (signal.size() < shortest) {
    throw InputError("length of " + name, fmt::format("{} samples", signal.size()),
                     fmt::format("{} or more", shortest));
  }
  for (Eigen::Index k = 0; k < signal.size(); ++k) {
    if (!std::isfinite(signal[k])) {
      throw InputError(name,
                       std::isnan(signal[k]) ? fmt::format("no value at sample {}", k)
                                             : fmt::format("{} at sample {}", signal[k], k),
                       "finite values only");
    }
  }
}

void require_same_length(const std::string& name_a, const Eigen::Ref<const Eigen::VectorXd>& a,
                         const std::string& name_b, const Eigen::Ref<const Eigen::VectorXd>& b) {
  if (a.size() != b.size()) {
    throw InputError("lengths of " + name_a + " and " + name_b, fmt::format("{} and {}", a.size(), b.size()),
                     "equal lengths");
  }
}

void require_confidence(double confidence) {
  if (!(confidence > 0.0 && confidence < 1.0)) {
    throw InputError("confidence level", fmt::format("{}", confidence), "above 0 and below 1");
  }
}

bool stands_still(const Eigen::Ref<const Eigen::VectorXd>& signal) {
  return signal.size() == 0 || (signal.array() == signal[0]).all();
}

double variance_floor(const Eigen::Ref<const Eigen::VectorXd>& signal) {
  if (signal.size() == 0) {
    return 0.0;
  }
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * signal.cwiseAbs().maxCoeff();
  return rounding * rounding;
}

}  // namespace mpm
