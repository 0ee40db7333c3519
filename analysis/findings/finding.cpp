#include "analysis/findings/finding.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/non_finite.hpp"

namespace mpm {

Finding Finding::with(const Rate& rate) const {
  Finding finding = with(rate.value, rate.interval, rate.total);
  finding.form = FindingForm::share;
  finding.hits = rate.hits;
  return finding;
}

Finding Finding::with(double number, const Interval& ends, std::int64_t behind) const {
  Finding finding = *this;
  finding.value = number;
  finding.interval = ends;
  finding.count = behind;
  return finding;
}

std::optional<bool> Finding::agrees(double confidence) const {
  if (!has_reported() || std::isnan(interval.lower))
    return std::nullopt;
  if (!is_share() || reported_of == 0 || hits < 0)
    return interval.contains(reported);
  return difference_interval(rate(hits, count, confidence), reported, reported_of, confidence).contains(0.0);
}

Finding counted(Finding like, std::int64_t experiments) {
  like.has_interval = false;
  like.value = static_cast<double>(experiments);
  like.count = experiments;
  return like;
}

std::vector<Finding> summary_findings(const Finding& of, const SampleSummary& summary) {
  const auto row = [&](const char* suffix, const char* word, bool has_interval, double value,
                       const Interval& interval) {
    Finding finding = of.with(value, interval, summary.count);
    finding.name += suffix;
    finding.label = word + of.label;
    finding.meaning = word + of.meaning;
    finding.has_interval = has_interval;
    return finding;
  };
  return {row("_min", "smallest ", false, summary.least, {kNaN, kNaN}),
          row("_mean", "mean ", true, summary.mean, summary.mean_interval),
          row("_max", "largest ", false, summary.largest, {kNaN, kNaN})};
}

const Finding* find_finding(const std::vector<Finding>& findings, std::string_view name) {
  const auto found = std::find_if(findings.begin(), findings.end(),
                                  [name](const Finding& each) { return each.name == name; });
  return found == findings.end() ? nullptr : &*found;
}

}  // namespace mpm
