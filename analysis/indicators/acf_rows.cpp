// The numbers of a comparison of autocorrelation functions.

#include <string>
#include <utility>

#include "analysis/indicators/acf_comparison.hpp"

namespace mpm {
namespace {

using AcfRows = std::vector<Row<AcfComparison>>;

void append_features(AcfRows& rows, const std::string& of, AcfFeatures AcfComparison::*features) {
  const auto add = [&]<class T>(T, const char* name, const char* meaning, const char* unit, auto... lens) {
    rows.push_back(member_row<T, AcfComparison>(
        {std::string(name) + "_" + of, std::string(meaning) + ", of " + of, unit}, path(features, lens...)));
  };
  constexpr double kQuantity = 0.0;
  const auto oscillation = &AcfFeatures::oscillation;
  add(kQuantity, "decay_lag", "lag from which on |ACF| stays below its level", "samples",
      &AcfFeatures::decay_lag);
  add(std::int8_t{}, "oscillation", "whether the ACF oscillates", "1", oscillation, &AcfOscillation::verdict);
  rows.back().text.words = enum_words<Oscillation>();
  add(kQuantity, "decay_ratio", "decay ratio of the ACF over half a period", "1", oscillation,
      &AcfOscillation::decay_ratio);
  add(kQuantity, "period", "period of the ACF", "samples", oscillation, &AcfOscillation::period);
}

}  // namespace

std::vector<Row<AcfComparison>> acf_rows() {
  using A = AcfComparison;
  AcfRows rows;
  for (const auto& [of, features] : {std::pair{"y", &A::y}, {"y0", &A::y0}, {"y0_diag", &A::y0_diag}})
    append_features(rows, of, features);
  const auto add = [&rows](const char* name, const char* meaning, double A::*member) {
    rows.push_back(member_row<double>({name, meaning}, member));
  };
  add("white_band", "half width of the band of white noise", &A::white_band);
  add("decay_lag_ratio", "decay lag of y over that of y0", &A::decay_lag_ratio);
  add("decay_margin", "largest ratio at which decay lags count as alike", &A::decay_margin);
  add("y_from_y0", "distance of ACF(y) from ACF(y0)", &A::y_from_y0);
  add("y_from_y0_diag", "distance of ACF(y) from ACF(y0_diag)", &A::y_from_y0_diag);
  add("y0_diag_from_y0", "distance of ACF(y0_diag) from ACF(y0)", &A::y0_diag_from_y0);
  add("own_share", "1 when y0_diag is like y0, 0 when it is like y", &A::own_share);
  rows.push_back(member_row<std::int8_t>(
      {"loop_speed", "speed of y against that of y0", "1", "", enum_words<LoopSpeed>()}, &A::speed));
  rows.push_back(member_row<std::int8_t>(
      {"error_origin", "origin of the error in the ACF: the model of this CV, or of others", "1", "",
       enum_words<ErrorOrigin>()},
      &A::origin));
  return rows;
}

}  // namespace mpm
