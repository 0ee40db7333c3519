// The numbers of a comparison of autocorrelation functions, by name.

#include <array>
#include <string>

#include "analysis/indicators/acf_comparison.hpp"

namespace mpm {
namespace {

struct Number {
  const char* name;
  const char* unit;
  const char* meaning;
  double AcfComparison::*member;
};

constexpr std::array<Number, 7> kNumbers{{
    {"white_band", "1", "half width of the band of white noise", &AcfComparison::white_band},
    {"decay_lag_ratio", "1", "decay lag of y over that of y0", &AcfComparison::decay_lag_ratio},
    {"decay_margin", "1", "ratio up to which decay lags are alike", &AcfComparison::decay_margin},
    {"y_from_y0", "1", "distance of ACF(y) from ACF(y0)", &AcfComparison::y_from_y0},
    {"y_from_y0_diag", "1", "distance of ACF(y) from ACF(y0_diag)", &AcfComparison::y_from_y0_diag},
    {"y0_diag_from_y0", "1", "distance of ACF(y0_diag) from ACF(y0)", &AcfComparison::y0_diag_from_y0},
    {"own_share", "1", "1 when y0_diag is like y0, 0 when it is like y", &AcfComparison::own_share},
}};

struct Record {
  const char* name;
  AcfFeatures AcfComparison::*member;
};

constexpr std::array<Record, 3> kRecords{
    {{"y", &AcfComparison::y}, {"y0", &AcfComparison::y0}, {"y0_diag", &AcfComparison::y0_diag}}};

using AcfColumns = std::vector<NumberColumn<AcfComparison>>;

/// The words of enumerators that count from 0.
template <class Enum, std::size_t n>
std::vector<std::string> words(const std::array<Enum, n>& enumerators) {
  std::vector<std::string> list;
  for (const Enum enumerator : enumerators) {
    list.emplace_back(to_string(enumerator));
  }
  return list;
}

void append_features(AcfColumns& columns, const Record& record) {
  const std::string of = std::string(" of ") + record.name;
  const auto name = [&record](const char* quantity) { return std::string(quantity) + "_" + record.name; };
  const auto member = record.member;
  columns.push_back({name("decay_lag"), "samples", "lag from which on |ACF| stays below its level," + of,
                     [member](const AcfComparison& c) { return (c.*member).decay_lag; },
                     [member](AcfComparison& c, double value) { (c.*member).decay_lag = value; }});
  columns.push_back(
      {name("oscillation"), "1", "whether the ACF oscillates," + of,
       [member](const AcfComparison& c) { return static_cast<double>((c.*member).oscillation.verdict); },
       [member](AcfComparison& c, double value) {
         (c.*member).oscillation.verdict = static_cast<Oscillation>(value);
       },
       words(std::array{Oscillation::undetermined, Oscillation::absent, Oscillation::present})});
  columns.push_back(
      {name("decay_ratio"), "1", "decay ratio of the ACF over half a period," + of,
       [member](const AcfComparison& c) { return (c.*member).oscillation.decay_ratio; },
       [member](AcfComparison& c, double value) { (c.*member).oscillation.decay_ratio = value; }});
  columns.push_back({name("period"), "samples", "period of the ACF," + of,
                     [member](const AcfComparison& c) { return (c.*member).oscillation.period; },
                     [member](AcfComparison& c, double value) { (c.*member).oscillation.period = value; }});
}

}  // namespace

std::vector<NumberColumn<AcfComparison>> acf_columns() {
  AcfColumns columns;
  for (const Record& record : kRecords) {
    append_features(columns, record);
  }
  for (const Number& number : kNumbers) {
    columns.push_back({number.name, number.unit, number.meaning,
                       [member = number.member](const AcfComparison& c) { return c.*member; },
                       [member = number.member](AcfComparison& c, double value) { c.*member = value; }});
  }
  columns.push_back(
      {"loop_speed", "1", "speed of y against that of y0",
       [](const AcfComparison& c) { return static_cast<double>(c.speed); },
       [](AcfComparison& c, double value) { c.speed = static_cast<LoopSpeed>(value); },
       words(std::array{LoopSpeed::undetermined, LoopSpeed::alike, LoopSpeed::slower, LoopSpeed::faster})});
  columns.push_back(
      {"error_origin", "1", "whose model the error that shows in the ACF comes from",
       [](const AcfComparison& c) { return static_cast<double>(c.origin); },
       [](AcfComparison& c, double value) { c.origin = static_cast<ErrorOrigin>(value); },
       words(std::array{ErrorOrigin::none, ErrorOrigin::own, ErrorOrigin::others, ErrorOrigin::both})});
  return columns;
}

}  // namespace mpm
