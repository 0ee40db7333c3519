#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/findings/loop_outcome.hpp"
#include "analysis/findings/world_counts.hpp"
#include "analysis/statistics/interval.hpp"
#include "scenarios/study/study.hpp"

// The numbers by which methods are compared. Each number is a row. Text, JSON, archive, report, board, gates
// and the Python package iterate over the rows and take names and headings from them.

namespace mpm {

/// What a study needs to have a number.
enum class StudyFeature : std::int8_t {
  any,
  candidates,
  calibration,
  monitoring,
  worlds,
  calibrated_worlds,
};

bool has_feature(const Study& study, StudyFeature feature);

/// A number of a method. No two have the same name or heading (method_numbers()).
struct MethodNumber {
  const char* name;     ///< "false_alarm_healthy"
  const char* heading;  ///< of tables and figures: "Healthy flagged"
  const char* meaning;  ///< the loops that the rate covers, and the hits among them
  bool low_is_good = false;
  StudyFeature of = StudyFeature::any;
};

/// A rate: a share of loops.
struct RateRow : MethodNumber {
  bool (*counts)(const JudgedLoop&);  ///< whether the loop counts for the rate
  bool (*hit)(const JudgedLoop&);     ///< whether the loop is a hit; asked only of loops that count

  /// Whether the loop is a hit; none if it does not count.
  std::optional<bool> ask(const JudgedLoop& loop) const {
    return counts(loop) ? std::optional(hit(loop)) : std::nullopt;
  }
};

/// Every rate once, in the order in which people read them.
std::span<const RateRow> rate_rows();

/// The row of this name; throws std::out_of_range when there is none.
template <class Row>
const Row& row_of(std::span<const Row> rows, std::string_view name) {
  const auto found =
      std::find_if(rows.begin(), rows.end(), [name](const Row& row) { return row.name == name; });
  if (found == rows.end())
    throw std::out_of_range("no number of methods is called " + std::string(name));
  return *found;
}

/// Returns the rows that this study can have.
template <class Row>
std::vector<std::reference_wrapper<const Row>> rows_for(const Study& study, std::span<const Row> rows) {
  std::vector<std::reference_wrapper<const Row>> found;
  for (const Row& row : rows)
    if (has_feature(study, row.of))
      found.emplace_back(row);
  return found;
}

/// A value for each of some rows. The rows must outlive it.
template <class Row, class Value>
class RowValues {
 public:
  explicit RowValues(std::span<const Row> rows) : rows_(rows), values_(rows.size()) {}

  std::span<const Row> rows() const { return rows_; }
  Value& of(const Row& row) { return values_[static_cast<std::size_t>(&row - rows_.data())]; }
  const Value& of(const Row& row) const { return values_[static_cast<std::size_t>(&row - rows_.data())]; }
  /// The value of this name; throws std::out_of_range when no row has it.
  Value& operator[](std::string_view name) { return of(row_of(rows_, name)); }
  const Value& operator[](std::string_view name) const { return of(row_of(rows_, name)); }

 private:
  std::span<const Row> rows_;
  std::vector<Value> values_;
};

struct Rates : RowValues<RateRow, Rate> {
  explicit Rates(std::span<const RateRow> rows = rate_rows()) : RowValues(rows) {}
};

/// What a rate would be under each of the redrawn thresholds (CalibratedThresholds::redrawn_05).
class RedrawnShare {
 public:
  /// Adds a loop that counts: whether it is a hit if its score is below the threshold, whether it is a hit if
  /// its score is above, and how many of the redrawn thresholds its score exceeds.
  void add(bool below, bool above, int exceeded);
  /// The variance of the share over the redrawn thresholds, (sum of squares about the mean) / (kRedraws - 1);
  /// 0 if the thresholds do not change the share.
  double variance() const;

 private:
  std::int64_t below_ = 0, total_ = 0;
  std::array<std::int64_t, kRedraws + 1> changes_ = {};  ///< sum of above - below, by thresholds exceeded
};

/// Counts the loops of each rate, by world.
class RateCounts {
 public:
  explicit RateCounts(std::span<const RateRow> rows = rate_rows()) : counts_(rows), redrawn_(rows) {}

  void add(const JudgedLoop& loop, int world);
  Rates rates(double confidence) const;

 private:
  RowValues<RateRow, WorldCount> counts_;
  RowValues<RateRow, RedrawnShare> redrawn_;
};

}  // namespace mpm
