#include "analysis/validation/record_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/methods/assessed_loop.hpp"
#include "analysis/sensitivity/nominal_output.hpp"
#include "analysis/statistics/quantile.hpp"
#include "analysis/statistics/standstill.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "plants/analyser.hpp"

namespace mpm {
namespace {

constexpr double kFarFromZero = 8.0;   // standard deviations
constexpr double kOftenBeyond = 0.05;  // of the samples
constexpr double kFarMore = 0.8;       // explained, in the sum over the CVs
constexpr double kNothing = 0.05;      // least explained share of a CV that counts
constexpr double kRoundingShare = 1e-12;

/// One variable of the record.
struct RecordedVariable {
  std::string name;
  Eigen::RowVectorXd values;
  double lower, upper;  ///< hard limits; infinite without
  bool is_cv;

  Eigen::ArrayXd present() const {
    Eigen::ArrayXd kept(values.size());
    Eigen::Index count = 0;
    for (const double value : values)
      if (!std::isnan(value))
        kept(count++) = value;
    return kept.head(count);
  }
  bool is_limited() const { return std::isfinite(lower) && std::isfinite(upper) && upper > lower; }
};

std::vector<RecordedVariable> variables_of(const Study& study, const PlantRecord& record) {
  std::vector<RecordedVariable> all;
  const auto add = [&](const std::vector<PlantModel::Variable>& variables, const Eigen::MatrixXd& values,
                       const Limits& limits, bool is_cv) {
    for (std::size_t i = 0; i < variables.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      all.push_back({variables[i].name, values.row(row), limits.lower(row), limits.upper(row), is_cv});
    }
  };
  add(study.plant.cvs, record.y, study.controller.cv_hard, true);
  add(study.plant.mvs, record.u, study.controller.mv_hard, false);
  add(study.plant.mds, record.d, Limits::none(study.md_count()), false);
  return all;
}

double deviation_of(const Eigen::ArrayXd& values) {
  return std::sqrt((values - values.mean()).square().mean());
}

/// Whether it never moves, except for rounding relative to the range in which it may move.
bool is_constant(const RecordedVariable& variable) {
  const Eigen::ArrayXd values = variable.present();
  const double width = variable.is_limited() ? variable.upper - variable.lower : 0.0;
  return values.size() > 0 &&
         ((values - values(0)).abs() <= kRoundingShare * std::max(width, std::abs(values(0)))).all();
}

void refuse_out_of_proportion(const RecordedVariable& variable) {
  for (Eigen::Index k = 0; k < variable.values.size(); ++k)
    if (const double value = variable.values(k); std::abs(value) > kLargestValue)
      throw InputError(
          fmt::format("record of {}", variable.name),
          fmt::format("{:g} at sample {}, which is implausible", value, k),
          fmt::format("values up to {:g}: look at its unit (data.scale) and its quality (data.quality)",
                      kLargestValue));
}

/// Returns the values without those of a frozen instrument.
Eigen::ArrayXd without_frozen(const Eigen::ArrayXd& values) {
  const Standstill stretch = longest_standstill(values.matrix().transpose());
  if (!is_frozen(stretch, values.size()) || stretch.length() == values.size())
    return values;
  Eigen::ArrayXd left(values.size() - stretch.length());
  left << values.head(stretch.first), values.tail(values.size() - stretch.end);
  return left;
}

/// Whether it looks like an absolute value.
bool is_far_off(const RecordedVariable& variable) {
  const Eigen::ArrayXd values = without_frozen(variable.present());
  const double mean = values.mean();
  if (!variable.is_limited())
    return !is_constant(variable) && std::abs(mean) > kFarFromZero * deviation_of(values);
  const double width = variable.upper - variable.lower;
  return mean < variable.lower - width || mean > variable.upper + width;
}

/// Returns the mean of the values as they are in the file; 0 if it differs from 0 only by the rounding of a
/// sum.
double recorded_mean(const Study& study, const RecordedVariable& variable) {
  const auto of = [&](const DataOptions::Numbers& numbers, double fallback) {
    const auto found = numbers.find(variable.name);
    return found == numbers.end() ? fallback : found->second;
  };
  const Eigen::ArrayXd recorded =
      variable.present() / of(study.data.scale, 1.0) + of(study.data.operating_point, 0.0);
  const double mean = recorded.mean();
  return std::abs(mean) < kRoundingShare * recorded.abs().maxCoeff() ? 0.0 : mean;
}

void check_absolute(const Study& study, const std::vector<RecordedVariable>& variables,
                    std::vector<std::string>& warnings) {
  std::vector<std::string> found;
  for (const RecordedVariable& variable : variables) {
    if (!is_far_off(variable))
      continue;
    const std::string range =
        variable.is_limited() ? fmt::format("hard limits [{:g}, {:g}]", variable.lower, variable.upper)
                              : fmt::format("standard deviation {:.3g}", deviation_of(variable.present()));
    if (study.data.operating_point.contains(variable.name))
      warnings.push_back(fmt::format(
          "{} is on average {:.4g} from its operating point ({}): check data.operating_point and data.scale",
          variable.name, variable.present().mean(), range));
    else
      found.push_back(
          fmt::format("{} with mean {:.6g} ({})", variable.name, recorded_mean(study, variable), range));
  }
  if (found.empty())
    return;
  std::vector<std::string> means;
  for (const RecordedVariable& variable : variables)
    means.push_back(fmt::format("{} = {:.6g}", variable.name, recorded_mean(study, variable)));
  throw InputError(
      "record", fmt::format("values that look absolute: {}", fmt::join(found, ", ")),
      fmt::format("deviations from the operating point of the study, which [data] of the study file makes of "
                  "absolute values. If the plant was at its operating point on average, use the means of the "
                  "record:\n"
                  "  [data]\n  operating_point = {{{}}}\n"
                  "For a variable recorded as a deviation it is 0; give a different unit in data.scale",
                  fmt::join(means, ", ")));
}

void check_movement(const std::vector<RecordedVariable>& variables, std::vector<std::string>& warnings) {
  for (const RecordedVariable& variable : variables) {
    const Eigen::ArrayXd values = variable.present();
    if (!is_constant(variable))
      continue;
    if (variable.is_cv)
      throw InputError(variable.name, fmt::format("{:g} in every sample", values(0)),
                       "a measurement that changes; this one may be a wrong tag, a frozen instrument, or a "
                       "historian that keeps changes only (data.tags)");
    warnings.push_back(fmt::format(
        "{} never moves: it was held, or the tag is wrong (data.tags); its channels cannot be judged",
        variable.name));
  }
}

void refuse_twins(const std::vector<RecordedVariable>& variables) {
  for (std::size_t a = 0; a < variables.size(); ++a)
    for (std::size_t b = a + 1; b < variables.size(); ++b) {
      const Eigen::RowVectorXd &x = variables[a].values, &z = variables[b].values;
      const bool same = ((x.array() == z.array()) || (x.array().isNaN() && z.array().isNaN())).all();
      if (same && !is_constant(variables[a]))
        throw InputError(fmt::format("{} and {}", variables[a].name, variables[b].name),
                         "the same values in both", "a column for each; one of the tags is wrong");
    }
}

void check_values(const RecordedVariable& variable, std::vector<std::string>& warnings) {
  const Eigen::ArrayXd values = variable.present();
  if (variable.is_limited()) {
    const double tolerance = 1e-6 * (variable.upper - variable.lower);
    const double beyond =
        (values < variable.lower - tolerance || values > variable.upper + tolerance).cast<double>().mean();
    if (beyond > kOftenBeyond)
      warnings.push_back(
          fmt::format("{} is beyond its hard limits [{:g}, {:g}] in {:.0f} % of the samples: its unit "
                      "(data.scale), operating point or limits differ from those of the study",
                      variable.name, variable.lower, variable.upper, 100.0 * beyond));
  }
  const Standstill longest = longest_standstill(variable.values);
  if (variable.is_cv && is_long(longest, variable.values.size()))
    warnings.push_back(
        fmt::format("{} stays at one value for {} samples: a frozen instrument, or a historian "
                    "that keeps changes only; give its quality, or leave the period out",
                    variable.name, longest.length()));
}

/// Whether a CV stays away from a level for most of the time, by more than it moves meanwhile.
bool stays_away(const Eigen::RowVectorXd& y, double level) {
  constexpr Eigen::Index kBlocks = 20;
  constexpr double kFarAway = 2.0;  // standard deviations within a block
  std::vector<double> distances, deviations;
  const Eigen::Index length = y.size() / kBlocks;
  for (Eigen::Index block = 0; length > 1 && block < kBlocks; ++block) {
    const Eigen::RowVectorXd part = y.segment(block * length, length);
    const auto there = !part.array().isNaN();
    const double count = there.cast<double>().sum();
    if (count < 2.0)
      continue;
    const double mean = there.select(part.array(), 0.0).sum() / count;
    distances.push_back(std::abs(mean - level));
    deviations.push_back(std::sqrt(there.select((part.array() - mean).square(), 0.0).sum() / count));
  }
  return !distances.empty() && upper_median(distances) > kFarAway * upper_median(deviations);
}

void check_setpoints(const Study& study, const PlantRecord& record, std::vector<std::string>& warnings) {
  for (const Eigen::Index cv : cvs_away_from_setpoints(study, record))
    warnings.push_back(fmt::format(
        "{} does not follow its setpoint {:g}. The record has no setpoint, so this is that of the study: "
        "name its column (data.setpoint), otherwise a moved setpoint counts as a fault",
        study.plant.cvs[static_cast<std::size_t>(cv)].name, study.simulation.initial_setpoint(cv)));
}

// --- Exchanged columns ---

Eigen::MatrixXd simulated(const Study& study, const Eigen::MatrixXd& u, const Eigen::MatrixXd& d) {
  const Eigen::MatrixXd moves = u.colwise() - u.col(0);
  const Eigen::MatrixXd disturbances =
      as_taken_in_record(study.controller.md_analysers, d.colwise() - d.col(0));
  return simulated_output(study.assessed_model(), study.controller.sample_time,
                          Eigen::VectorXd::Zero(u.rows()), moves, disturbances);
}

/// The share of a CV that y_sim explains, -1 to 1; 0 if y_sim does not move the CV.
double explained(const Eigen::RowVectorXd& y, const Eigen::RowVectorXd& y_sim) {
  const auto there = !y.array().isNaN();
  const double count = std::max(1.0, there.cast<double>().sum());
  const auto variance = [&](const Eigen::RowVectorXd& signal) {
    const Eigen::ArrayXXd kept = there.select(signal.array(), 0.0);
    const double mean = kept.sum() / count;
    return there.select((signal.array() - mean).square(), 0.0).sum() / count;
  };
  const double of_y = variance(y);
  return of_y == 0.0 ? 0.0 : std::max(-1.0, 1.0 - variance(y - y_sim) / of_y);
}

double explained(const Eigen::MatrixXd& y, const Eigen::MatrixXd& y_sim) {
  double sum = 0.0;
  for (Eigen::Index cv = 0; cv < y.rows(); ++cv)
    sum += explained(Eigen::RowVectorXd(y.row(cv)), Eigen::RowVectorXd(y_sim.row(cv)));
  return sum;
}

/// Tries what people often confuse, and reports what makes the model explain far more.
class ExchangeSearch {
 public:
  ExchangeSearch(const Study& study, const PlantRecord& record)
      : study_(study),
        record_(record),
        y_(behind_washout(study, record.y)),
        y_sim_(simulated(study, record.u, record.d)),
        explained_(explained(y_, y_sim_)) {}

  std::vector<std::string> findings() {
    pairs(study_.plant.cvs, [&](Eigen::Index a, Eigen::Index b) {
      Eigen::MatrixXd y = record_.y;
      y.row(a).swap(y.row(b));
      return explained(behind_washout(study_, std::move(y)), y_sim_);
    });
    pairs(study_.plant.mvs, [&](Eigen::Index a, Eigen::Index b) {
      Eigen::MatrixXd u = record_.u;
      u.row(a).swap(u.row(b));
      return explained(y_, simulated(study_, u, record_.d));
    });
    pairs(study_.plant.mds, [&](Eigen::Index a, Eigen::Index b) {
      Eigen::MatrixXd d = record_.d;
      d.row(a).swap(d.row(b));
      return explained(y_, simulated(study_, record_.u, d));
    });
    for (Eigen::Index mv = 0; mv < record_.u.rows(); ++mv) {
      Eigen::MatrixXd u = record_.u;
      u.row(mv) *= -1.0;
      if (explained(y_, simulated(study_, u, record_.d)) > explained_ + kFarMore)
        found_.push_back(
            fmt::format("the model explains far more of the CVs with the sign of {} reversed: check its "
                        "data.scale, or whether the valve closes where the model opens it",
                        study_.plant.mvs[static_cast<std::size_t>(mv)].name));
    }
    if (found_.empty() && explains_nothing())
      found_.emplace_back(
          "the model explains nothing of any CV: the tags, units, operating point or time stamps are wrong, "
          "or the faults outweigh the model");
    return std::move(found_);
  }

 private:
  /// Whether the model explains nothing of any CV, in the whole record and in its second half, which an
  /// unknown past no longer affects.
  bool explains_nothing() const {
    for (const Eigen::Index samples : {record_.samples(), record_.samples() / 2})
      for (Eigen::Index cv = 0; cv < record_.y.rows(); ++cv)
        if (explained(Eigen::RowVectorXd(y_.row(cv).tail(samples)),
                      Eigen::RowVectorXd(y_sim_.row(cv).tail(samples))) >= kNothing)
          return false;
    return true;
  }

  template <class Swapped>
  void pairs(const std::vector<PlantModel::Variable>& variables, Swapped swapped) {
    for (std::size_t a = 0; a < variables.size(); ++a)
      for (std::size_t b = a + 1; b < variables.size(); ++b)
        if (swapped(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) > explained_ + kFarMore)
          found_.push_back(fmt::format(
              "the model explains far more of the CVs with {} and {} exchanged: check their tags (data.tags)",
              variables[a].name, variables[b].name));
  }

  const Study& study_;
  const PlantRecord& record_;
  Eigen::MatrixXd y_, y_sim_;
  double explained_;
  std::vector<std::string> found_;
};

}  // namespace

std::vector<std::string> check_record(const Study& study, const PlantRecord& record) {
  const std::vector<RecordedVariable> variables = variables_of(study, record);
  for (const RecordedVariable& variable : variables)
    refuse_out_of_proportion(variable);
  std::vector<std::string> warnings;
  check_movement(variables, warnings);
  check_absolute(study, variables, warnings);
  refuse_twins(variables);
  for (const RecordedVariable& variable : variables)
    check_values(variable, warnings);
  check_setpoints(study, record, warnings);
  for (std::string& finding : ExchangeSearch(study, record).findings())
    warnings.push_back(std::move(finding));
  return warnings;
}

std::vector<Eigen::Index> cvs_away_from_setpoints(const Study& study, const PlantRecord& record) {
  std::vector<Eigen::Index> away;
  const auto kept = [&record](Eigen::Index cv) {
    Eigen::RowVectorXd y = record.y.row(cv);
    for (Eigen::Index k = 0; k < y.size(); ++k)
      if (record.has_cv_off(cv, k))
        y(k) = kNaN;
    return y;
  };
  for (Eigen::Index cv = 0; cv < record.y.rows(); ++cv)
    if (study.controller.has_setpoint(cv) && std::isnan(record.y_set(cv, 0)) &&
        stays_away(kept(cv), study.simulation.initial_setpoint(cv)))
      away.push_back(cv);
  return away;
}

}  // namespace mpm
