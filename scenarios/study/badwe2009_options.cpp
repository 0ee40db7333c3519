#include "scenarios/study/badwe2009_options.hpp"

#include <string>

#include <fmt/format.h>

#include "plants/error.hpp"

namespace mpm {
namespace {

void require(bool allowed, const std::string& name, double value, const std::string& range) {
  if (!allowed)
    throw InputError(name, fmt::format("{}", value), range);
}

void require_at_least(int smallest, const std::string& name, int value) {
  require(value >= smallest, name, value, fmt::format("{} or more", smallest));
}

void require_share(const std::string& name, double value) {
  require(value >= 0.0 && value <= 1.0, name, value, "0 to 1");
}

}  // namespace

void Badwe2009Options::validate() const {
  require_at_least(1, "length of a noise filter", filter_length);
  require_at_least(1, "nb of a decorrelation", nb);
  require_at_least(0, "nf of a decorrelation", nf);
  require_at_least(1, "length of the regression of a decorrelation", fir_length);
  require(fir_pole >= 0.0 && fir_pole < 1.0, "pole of the regression of a decorrelation", fir_pole,
          "0 or more, below 1");
  require_at_least(0, "smallest lag", min_lag);
  require_at_least(min_lag, "largest lag", max_lag);
  require(confidence > 0.0 && confidence < 1.0, "confidence", confidence, "above 0 and below 1");
  require_share("weakest correlation that counts", weakest_correlation);
  require_share("share of saturated samples", saturated_share);
  require(smallest_deviation >= 0.0, "smallest standard deviation of an MV", smallest_deviation, "0 or more");
  require_share("share of an MV's variance that is its own", smallest_own_share);
}

}  // namespace mpm
