#include "analysis/identification/prediction_error_options.hpp"

#include <string>

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {
namespace {

void require_share(const std::string& name, double value) {
  if (!(value > 0.0 && value < 1.0))
    throw InputError(name, fmt::format("{}", value), "above 0 and below 1");
}

}  // namespace

void PredictionErrorOptions::validate() const {
  if (first_sample < 0)
    throw InputError("first sample of the loss", fmt::format("{}", first_sample), "0 or later");
  if (max_iterations < 1)
    throw InputError("iteration limit", fmt::format("{}", max_iterations), "1 or more");
  if (max_starts < 1)
    throw InputError("number of starts", fmt::format("{}", max_starts), "1 or more");
  require_share("largest radius of the roots", largest_radius);
  require_share("rank tolerance", rank_tolerance);
}

}  // namespace mpm
