#include "results/plot/plot_axis.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "results/plot/plot_text.hpp"

namespace mpm {
namespace {

/// Tells whether plot_number() writes the ends and ticks of this range as different numbers.
bool is_wide(double lower, double upper) {
  constexpr double kLeastShare = 1e-4;
  return upper - lower > kLeastShare * std::max(std::abs(lower), std::abs(upper));
}

/// Returns the limits of an axis. A limit that is not set follows from the data, with a margin; so do both if
/// the limits that are set leave no range between them.
std::pair<double, double> limits(const Axis& axis, double lower, double upper) {
  constexpr double kMargin = 0.05;
  if (lower > upper)  // nothing is drawn
    lower = upper = 1.0;
  if (axis.logarithmic) {
    const double factor = std::max(1.1, std::pow(upper / lower, kMargin));
    lower /= factor;
    upper *= factor;
  } else {
    const double margin = is_wide(lower, upper)
                              ? kMargin * (upper - lower)
                              : std::max(0.5 * std::max(std::abs(lower), std::abs(upper)), 0.1);
    lower -= margin;
    upper += margin;
  }
  const double first = shows_value(axis, axis.lower) ? axis.lower : lower;
  const double last = shows_value(axis, axis.upper) ? axis.upper : upper;
  return is_wide(first, last) ? std::pair(first, last) : std::pair(lower, upper);
}

/// Returns the ticks of a logarithmic axis: 1, 2, 5 in each decade; if there are many decades, only the
/// decades, or every n-th of them.
std::vector<double> logarithmic_ticks(double lower, double upper) {
  constexpr double kMostTicks = 8;
  const double decades = std::log10(upper / lower);
  const int step = std::max(1, static_cast<int>(std::ceil(decades / kMostTicks)));
  std::vector<double> ticks;
  for (int exponent = static_cast<int>(std::floor(std::log10(lower))); exponent <= std::log10(upper);
       ++exponent)
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double tick = digit * std::pow(10.0, exponent);
      const bool wanted = exponent % step == 0 && (digit == 1.0 || decades <= 2.5);
      if (wanted && tick >= lower && tick <= upper)
        ticks.push_back(tick);
    }
  return ticks;
}

/// Returns the smallest step of 1, 2 or 5 times a power of ten that leaves `room` pixels for each tick.
double tick_step(double lower, double upper, double length, double room) {
  const double least = (upper - lower) * room / length;
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  for (const double digit : {1.0, 2.0, 5.0})
    if (digit * decade >= least)
      return digit * decade;
  return 10.0 * decade;
}

/// Returns a tick label for gnuplot. gnuplot reads it as a format, so a percent sign is written twice.
std::string tick_word(const std::string& label) {
  std::string word;
  for (const char c : gnuplot_label(label))
    word.append(c == '%' ? 2 : 1, c);
  return word;
}

std::string tick_commands(char which, const Axis& axis, double lower, double upper, double length) {
  std::vector<std::string> places;
  for (std::size_t i = 0; i < axis.words.size(); ++i)
    places.push_back(fmt::format("{} {}", tick_word(axis.words[i]), i));
  for (const double tick :
       axis.logarithmic&& axis.ticks.empty() ? logarithmic_ticks(lower, upper) : axis.ticks)
    if (shows_value(axis, tick))
      places.push_back(plot_number(tick));
  const double room = which == 'x' ? 42 : 28;  // numbers are wider than high
  if (places.empty())
    return fmt::format("set {}tics {}\n", which, plot_number(tick_step(lower, upper, length, room)));
  return fmt::format("set {}tics ({}){}\n", which, fmt::join(places, ", "),
                     axis.words.empty() ? "" : " scale 0");
}

}  // namespace

std::string plot_number(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "NaN";
}

bool shows_value(const Axis& axis, double value) {
  constexpr double kLargest = 1e100;
  return std::abs(value) <= kLargest && (!axis.logarithmic || value >= 1.0 / kLargest);
}

std::string axis_commands(char which, const Axis& axis, double least, double largest, double length) {
  const auto [lower, upper] = limits(axis, least, largest);
  std::string commands = fmt::format("set {}range [{}:{}]\n", which, plot_number(lower), plot_number(upper));
  if (!axis.label.empty())
    commands += fmt::format("set {}label {}\n", which, gnuplot_label(axis.label));
  if (axis.logarithmic)
    commands += fmt::format("set logscale {}\n", which);
  return commands + tick_commands(which, axis, lower, upper, length);
}

}  // namespace mpm
