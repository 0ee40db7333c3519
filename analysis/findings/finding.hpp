#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/statistics/interval.hpp"
#include "analysis/statistics/sample_summary.hpp"
#include "base/enum_words.hpp"
#include "base/non_finite.hpp"
#include "scenarios/faults/fault.hpp"

namespace mpm {

/// How people read a finding.
enum class FindingForm : std::int8_t {
  share,   ///< of experiments, 0 ... 1; people read a percentage
  number,  ///< any other number
};

template <>
inline constexpr auto kWords<FindingForm> = word_list("share", "number");

/// The heading under which a table lists a finding.
enum class FindingGroup : std::int8_t {
  study,      ///< all experiments
  kind,       ///< the experiments of one kind: Finding::kind
  dominance,  ///< experiments with both faults, by the dominance of the mismatch
  s0,         ///< effect of an error in S0
  faultless,  ///< experiments in which model and plant agree
  method,     ///< one method (Finding::method) on all loops, to compare methods
};

/// Where a finding is shown. Archive, gates and JSON have every finding in any case.
enum class Prominence : std::int8_t {
  headline,  ///< what a reader asks for first: shown in figures and in the table of a sweep as well
  table,     ///< shown in the tables of summary and report
  detail,    ///< shown nowhere else
};

/// One statistic of a study: its name, its meaning, and its value with its uncertainty. Archive, summary,
/// report, gates, sweep and the reported numbers of a study iterate over these rows; none of them parses a
/// name for its meaning.
struct Finding {
  std::string name;     ///< by which studies, gates and people refer to it: "mpm.located"
  std::string label;    ///< for tables under the heading of its group, with the marks of plot labels
  std::string meaning;  ///< which experiments the number covers, and what it counts
  FindingForm form = FindingForm::number;
  FindingGroup group = FindingGroup::study;
  Prominence prominence = Prominence::table;
  std::optional<ExperimentKind> kind = {};  ///< of the experiments; none: of several kinds
  std::string method = {};                  ///< method whose answers are counted; empty: no method
  bool has_interval = true;                 ///< whether it can have one; least and largest values cannot
  double value = kNaN;
  Interval interval{kNaN, kNaN};
  std::int64_t count = 0;        ///< experiments, pairs or loops behind it
  std::int64_t hits = -1;        ///< of a share: how many of `count` are hits; -1: not a share
  double reported = kNaN;        ///< value that others reported, as the study states; NaN: none
  std::int64_t reported_of = 0;  ///< number of experiments behind `reported`; 0: not stated

  bool is_share() const { return form == FindingForm::share; }
  bool has_reported() const { return reported == reported; }
  /// Whether the measured and the reported number can have the same true value. Two shares with known numbers
  /// of experiments agree if the interval of their difference contains 0 (difference_interval()). Any other
  /// number agrees if its interval contains the reported number, which is taken as exact. None without an
  /// interval or a reported number.
  std::optional<bool> agrees(double confidence) const;

  /// The finding with this value.
  Finding with(const Rate& rate) const;
  Finding with(double number, const Interval& interval, std::int64_t count) const;
};

/// The finding `like` with a number of experiments, which has no interval.
Finding counted(Finding like, std::int64_t experiments);

/// The rows least, mean and largest of a summary, named NAME_min, NAME_mean and NAME_max.
std::vector<Finding> summary_findings(const Finding& of, const SampleSummary& summary);

/// The finding of this name; null when there is none.
const Finding* find_finding(const std::vector<Finding>& findings, std::string_view name);

}  // namespace mpm
