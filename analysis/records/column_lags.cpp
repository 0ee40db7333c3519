#include "analysis/records/column_lags.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/records/channel_error_fit.hpp"
#include "base/non_finite.hpp"
#include "scenarios/faults/fault.hpp"

namespace mpm {
namespace {

constexpr Eigen::Index kMostShift = 3;
/// Least decrease of log_errors() by a shift, for each CV that the shift can change. One of 26 healthy
/// records (tests/reliability/records.py, seeds 2 and 3) had such a shift.
constexpr double kWorthNaming = 0.1;
constexpr Eigen::Index kFewestErrors = 50;

/// Moves the row `shift` samples later. Its ends keep the nearest value; those of a CV are missing.
void shift_row(Eigen::MatrixXd& signals, Eigen::Index row, Eigen::Index shift, bool is_cv) {
  const Eigen::RowVectorXd before = signals.row(row);
  const Eigen::Index N = before.size();
  for (Eigen::Index k = 0; k < N; ++k) {
    const Eigen::Index from = k - shift;
    const bool inside = from >= 0 && from < N;
    signals(row, k) = inside ? before(from) : is_cv ? kNaN : before(std::clamp<Eigen::Index>(from, 0, N - 1));
  }
}

/// Returns for each CV the logarithm of what errors of the model leave of the simulation errors
/// (ChannelErrorFit::left), ny; 0 for a CV with too few samples.
Eigen::VectorXd log_errors(const RecordFrame& frame, const PlantRecord& record) {
  const AssessedLoop loop = judged_loop(frame, record);
  const ChannelErrorFits fits(frame.as_kept, frame.model_error);
  Eigen::VectorXd logs = Eigen::VectorXd::Zero(loop.y.rows());
  for (Eigen::Index cv = 0; cv < logs.size(); ++cv)
    if ((!(loop.y.row(cv) - loop.y_sim.row(cv)).array().isNaN()).count() >= kFewestErrors)
      logs(cv) = std::log(std::max(fits.of(loop, cv).left, std::numeric_limits<double>::min()));
  return logs;
}

struct Shifted {
  std::string name;
  bool is_cv = false;
  Eigen::Index place = 0;  ///< row of G0 for a CV, otherwise its column
  Eigen::Index shift = 0;
  double gain = 0.0;   ///< mean decrease of log_errors() of the CVs that it can change
  double total = 0.0;  ///< the same, summed over all CVs
};

/// Returns whether a different dead time of one channel alone explains the record almost as well.
bool is_one_channel(const RecordFrame& frame, const PlantRecord& record, const Eigen::VectorXd& as_recorded,
                    const Shifted& column) {
  constexpr double kAsWell = 0.8;
  const TransferMatrix& G = frame.as_kept.plant.G;
  const double change =
      static_cast<double>(column.is_cv ? -column.shift : column.shift) * frame.as_kept.controller.sample_time;
  for (Eigen::Index cv = 0; cv < G.rows(); ++cv)
    for (Eigen::Index input = 0; input < G.cols(); ++input) {
      if ((column.is_cv ? cv : input) != column.place || G(cv, input).is_zero())
        continue;
      RecordFrame other = frame;
      const double shift = std::max(change, -G(cv, input).dead_time());
      other.as_kept.plant.G = with_mismatches(G, {{cv, input, MismatchParameter::dead_time, shift}});
      if ((as_recorded - log_errors(other, record)).sum() > kAsWell * column.total)
        return true;
    }
  return false;
}

/// CVs with one clock: the same shift explains each of them better by a tenth or more, and no other shift
/// does so as well. Empty if there are fewer than two.
struct SharedShift {
  std::vector<Eigen::Index> cvs;
  Eigen::Index shift = 0;
};

/// `gains`: what each CV (rows) gains from a shift of its own column by -kMostShift to kMostShift (columns).
SharedShift shared_shift(const Eigen::MatrixXd& gains) {
  SharedShift best;
  for (Eigen::Index column = 0; column < gains.cols(); ++column) {
    SharedShift here{.cvs = {}, .shift = column - kMostShift};
    for (Eigen::Index cv = 0; cv < gains.rows(); ++cv)
      if (gains(cv, column) >= kWorthNaming && gains(cv, column) == gains.row(cv).maxCoeff())
        here.cvs.push_back(cv);
    if (here.cvs.size() > best.cvs.size())
      best = std::move(here);
  }
  return best.cvs.size() < 2 ? SharedShift{} : best;
}

/// "1 sample too late"
std::string shift_text(Eigen::Index shift) {
  return fmt::format("{} sample{} too {}", std::abs(shift), std::abs(shift) == 1 ? "" : "s",
                     shift < 0 ? "late" : "early");
}

}  // namespace

std::vector<std::string> column_lags(const RecordFrame& frame, const PlantRecord& record) {
  const Study& study = frame.as_kept;
  const Eigen::VectorXd as_recorded = log_errors(frame, record);
  Shifted best, second;
  Eigen::MatrixXd of_cvs = Eigen::MatrixXd::Zero(study.cv_count(), 2 * kMostShift + 1);
  const auto look = [&](const std::vector<PlantModel::Variable>& variables,
                        Eigen::MatrixXd PlantRecord::*signals, bool is_cv, Eigen::Index first) {
    for (std::size_t i = 0; i < variables.size(); ++i) {
      Shifted own{.name = variables[i].name, .is_cv = is_cv, .place = first + static_cast<Eigen::Index>(i)};
      for (Eigen::Index shift = -kMostShift; shift <= kMostShift; ++shift) {
        if (shift == 0)
          continue;
        PlantRecord moved = record;
        shift_row(moved.*signals, static_cast<Eigen::Index>(i), shift, is_cv);
        const Eigen::VectorXd gains = as_recorded - log_errors(frame, moved);
        const double changed = (gains.array() != 0.0).cast<double>().sum();
        // A shift that is better for one CV and worse for another points to one channel, or to none.
        const double gain = gains.minCoeff() < -kWorthNaming || changed == 0.0 ? 0.0 : gains.sum() / changed;
        if (is_cv)
          of_cvs(own.place, shift + kMostShift) = gain;
        if (gain > own.gain) {
          own.gain = gain;
          own.total = gains.sum();
          own.shift = shift;
        }
      }
      if (own.gain > best.gain) {
        second = best;
        best = own;
      } else if (own.gain > second.gain) {
        second = own;
      }
    }
  };
  look(study.plant.cvs, &PlantRecord::y, true, 0);
  look(study.plant.mvs, &PlantRecord::u, false, 0);
  look(study.plant.mds, &PlantRecord::d, false, study.mv_count());
  if (const SharedShift shared = shared_shift(of_cvs); !shared.cvs.empty()) {
    std::vector<std::string> names;
    for (const Eigen::Index cv : shared.cvs)
      names.push_back(study.plant.cvs[static_cast<std::size_t>(cv)].name);
    return {
        fmt::format("the columns of {} seem to be {}, all by the same: they have one clock that is not that "
                    "of the others; look at how the historian stamps them",
                    fmt::join(names, ", "), shift_text(shared.shift))};
  }
  if (best.gain < kWorthNaming || second.gain > 0.9 * best.gain ||
      is_one_channel(frame, record, as_recorded, best))
    return {};
  return {
      fmt::format("the column of {} seems to be {}: the model explains the record better "
                  "when it is shifted (errors {:.0f} % smaller); look at how the historian stamps it{}",
                  best.name, shift_text(best.shift), 100.0 * (1.0 - std::exp(-0.5 * best.gain)),
                  !best.is_cv && best.place >= study.mv_count() && best.shift < 0
                      ? fmt::format(", or whether the controller has it late as well (analyser_delay in "
                                    "[controller.md.{}])",
                                    best.name)
                      : "")};
}

}  // namespace mpm
