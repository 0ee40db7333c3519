#include "results/records/time_order.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {
namespace {

constexpr double kHourOfClock = 3600.0;  // s

/// Checks the steps between neighbouring rows that are kept.
class StampSteps {
 public:
  StampSteps(const StampSource& source, const TimeStamps& stamps, const std::vector<std::size_t>& rows)
      : source_(source), stamps_(stamps), rows_(rows) {}

  double time(std::size_t place) const { return stamps_.times[rows_[place]]; }
  double step(std::size_t place) const { return time(place) - time(place - 1); }

  /// Refuses a step that no passing of time can make.
  void require_forward(std::size_t place) const {
    if (step(place) < 0.0)
      refuse_step_back(place);
    if (stamps_.calendar && !stamps_.offsets && is_spring_forward(place))
      throw InputError(
          where(place), fmt::format("{} after {}, an hour too late at night", text(place), text(place - 1)),
          "stamps in which no clock is put forward: export them in UTC (with Z, also where the hour is "
          "missing in truth), or with their offset (2024-03-31T03:00:00+02:00); or say in data.time_zone "
          "which clock it is");
  }

 private:
  std::string where(std::size_t place) const {
    return fmt::format("{}, line {}", source_.where, source_.lines[rows_[place]]);
  }
  std::string text(std::size_t place) const {
    return stamps_.calendar ? date_text(time(place)) : fmt::format("{:.15g}", time(place));
  }
  double step_before(std::size_t place) const { return place > 1 ? step(place - 1) : 0.0; }

  [[noreturn]] void refuse_step_back(std::size_t place) const {
    const double back = -step(place);
    const bool clock =
        stamps_.calendar && back <= kHourOfClock && back + step_before(place) >= kHourOfClock * 0.99;
    throw InputError(
        where(place), fmt::format("{} after {}", text(place), text(place - 1)),
        clock ? "stamps that do not go back by an hour, as local time does when the clock is put back: "
                "export them in UTC, or with their offset (2024-10-27T02:30:00+02:00); or say in "
                "data.time_zone which clock it is"
              : "stamps in ascending order: sort the rows, and leave out what was recorded twice");
  }

  /// Tells whether exactly one hour is missing at night, as when the clock is put forward.
  bool is_spring_forward(std::size_t place) const {
    const double usual = step_before(place);
    const double hour = std::fmod(time(place), 86400.0) / kHourOfClock;
    return usual > 0.0 && usual < kHourOfClock && std::abs(step(place) - usual - kHourOfClock) < 1.0 &&
           hour >= 2.0 && hour < 4.0;
  }

  const StampSource& source_;
  const TimeStamps& stamps_;
  const std::vector<std::size_t>& rows_;
};

}  // namespace

RowsInTime rows_in_time(const StampSource& source, const TimeStamps& stamps) {
  RowsInTime found;
  for (std::size_t row = 0; row < stamps.times.size(); ++row)
    if (!std::isnan(stamps.times[row]))
      found.rows.push_back(row);
  found.without = stamps.times.size() - found.rows.size();
  const auto later = [&](std::size_t a, std::size_t b) { return stamps.times[a] > stamps.times[b]; };
  found.turned = found.rows.size() > 1 && std::is_sorted(found.rows.begin(), found.rows.end(), later) &&
                 later(found.rows.front(), found.rows.back());
  if (found.turned)
    std::reverse(found.rows.begin(), found.rows.end());
  const StampSteps steps(source, stamps, found.rows);
  for (std::size_t place = 1; place < found.rows.size(); ++place) {
    found.doubles += steps.step(place) == 0.0 ? 1 : 0;
    steps.require_forward(place);
  }
  return found;
}

}  // namespace mpm
