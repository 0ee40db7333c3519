#include "analysis/records/record_panel.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/QR>
#include <Eigen/SVD>

#include "analysis/methods/method_table.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/records/cost_of_record.hpp"
#include "analysis/records/model_check.hpp"
#include "analysis/records/untold_part.hpp"
#include "analysis/validation/benchmark_period.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "scenarios/loop/historian.hpp"
#include "scenarios/loop/record_rows.hpp"
#include "scenarios/study/window_scan.hpp"

namespace mpm {
namespace {

bool needs_every_sample(const RecordFrame& frame, const std::string& method) {
  return method_table(frame.as_kept.assessment).method(method).requirements.complete_record;
}

/// Removes the samples of the CVs that have an unknown past.
void leave_out_unknown(const RecordFrame& frame, const std::vector<bool>& unknown, Eigen::MatrixXd& y) {
  Eigen::Index known = frame.settling;  // samples since the last unknown one
  for (std::size_t k = 0; k < unknown.size(); ++k) {
    known = unknown[k] ? -1 : known + 1;
    if (known < frame.settling)
      y.col(static_cast<Eigen::Index>(k)).setConstant(kNaN);
  }
}

/// The part of the errors of a CV that no record can tell, by least squares over the samples that are there.
Eigen::VectorXd untold(const Eigen::VectorXd& e, const Eigen::MatrixXd& columns) {
  const auto is_there = !e.array().isNaN();
  if (is_there.count() <= 2 * columns.cols())
    return Eigen::VectorXd::Zero(e.size());
  const Eigen::VectorXd right = is_there.select(e.array(), 0.0);
  const Eigen::MatrixXd left = columns.array().colwise() * is_there.cast<double>();
  return columns * left.completeOrthogonalDecomposition().solve(right);
}

/// Columns with the same span, made orthogonal and with a mean square of 1 over the samples that are there:
/// two memories that are nearly alike differ only faintly.
Eigen::MatrixXd alike(const Eigen::VectorXd& e, const Eigen::MatrixXd& columns) {
  constexpr double kSame = 1e-8;  // singular values, over the largest
  const auto is_there = !e.array().isNaN();
  const Eigen::MatrixXd there = columns.array().colwise() * is_there.cast<double>();
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(there, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::Index rank = (svd.singularValues().array() > kSame * svd.singularValues()(0)).count();
  const double size = std::sqrt(static_cast<double>(is_there.count()));
  return columns * svd.matrixV().leftCols(rank) *
         (size * svd.singularValues().head(rank).cwiseInverse()).asDiagonal();
}

/// The number of samples before the first one that is there.
Eigen::Index samples_before(const Eigen::VectorXd& e) {
  Eigen::Index k = 0;
  while (k < e.size() && std::isnan(e(k)))
    ++k;
  return k;
}

/// The loop with the gaps of its CVs closed, from the first sample that is judged on.
AssessedLoop without_gaps(AssessedLoop loop, Eigen::Index unjudged, GapFill fill) {
  auto judged = loop.y.rightCols(loop.samples() - unjudged);
  for (Eigen::Index cv = 0; cv < judged.rows(); ++cv)
    judged.row(cv) = filled(judged.row(cv), fill);
  return loop;
}

/// The record of the nominal loop.
AssessedLoop nominal_benchmark(const Study& study, const BasisCase& basis) {
  return assessed_loop(study, basis.point, recorded(study, basis_index(basis.world), basis.trajectory));
}

/// The same simulation errors under inputs that never move: a simulated loop has the noise of the record,
/// but shows nothing of the errors of its model, so that these stay as probable as they were before.
AssessedLoop without_moves(AssessedLoop loop, const OperatingPoint& point) {
  loop.u = point.u.replicate(1, loop.samples());
  loop.d.setZero();
  return loop;
}

std::pair<Eigen::Index, Eigen::Index> benchmark_of(const RecordFrame& frame, const PlantRecord& record,
                                                   const AssessedLoop& loop) {
  if (!frame.finds_benchmark)
    return record.benchmark;
  const auto found = best_period(frame, loop);
  if (found.first == found.second)
    throw InputError("data.benchmark", "\"found\", and no period with enough samples of a CV",
                     "two time stamps, or a longer record");
  return found;
}

/// Puts the costs of the CVs into the answer of model_check_method().
void add_costs(const RecordFrame& frame, const PlantRecord& record, AssessmentRecord& said) {
  if (frame.y0.size() == 0 || said.form->method().name != kModelCheck || !said.answered())
    return;
  const Eigen::VectorXd noise = said.values("noise").col(0);
  for (const auto& [number, from] :
       {std::pair{kCostNumber, frame.unjudged}, std::pair{kCostSinceNumber, frame.since}})
    for (const CvCost& cost :
         cost_of_record(frame.as_kept, record.y, frame.y0, noise, std::max(from, frame.unjudged)))
      said.set_number(number, cost.ratio, cost.cv);
}

}  // namespace

std::pair<Eigen::Index, Eigen::Index> best_period(const RecordFrame& frame, const AssessedLoop& loop) {
  const Eigen::Index fewest = window_scan(frame.as_kept).longest + kFewestCorrelatedPairs;
  return quietest_period(loop.y - loop.y_sim, loop.u, std::max(loop.samples() / kBenchmarkShare, fewest));
}

std::vector<bool> unknown_samples(const PlantRecord& record) {
  std::vector<bool> unknown(static_cast<std::size_t>(record.samples()), false);
  for (Eigen::Index k = 1; k < record.samples(); ++k)
    unknown[static_cast<std::size_t>(k)] = record.y.col(k).array().isNaN().all() &&
                                           record.u.col(k) == record.u.col(k - 1) &&
                                           record.d.col(k) == record.d.col(k - 1);
  return unknown;
}

AssessedLoop judged_loop(const RecordFrame& frame, const PlantRecord& record) {
  const Study& study = frame.as_kept;
  AssessedLoop loop = assessed_loop(study, frame.basis.point, record, frame.unjudged);
  for (Eigen::Index cv = 0; cv < loop.y_sim.rows(); ++cv)
    if (frame.late.has(cv))
      loop.y_sim.row(cv) = late_by(loop.y_sim.row(cv), frame.late.samples);
  const std::vector<bool> unknown = unknown_samples(record);
  leave_out_unknown(frame, unknown, loop.y);
  if (frame.model_error == 0.0)
    return loop;
  const std::vector<Eigen::Index> starts = starts_after_unknown(loop.y, frame.settling);
  for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv) {
    const Eigen::VectorXd e = (loop.y.row(cv) - loop.y_sim.row(cv)).transpose();
    const Eigen::MatrixXd columns = untold_columns(study, cv, starts, e.size());
    Eigen::VectorXd explained = untold(e, columns);
    // A constant here is a ramp before the washout, and there is none before the record.
    if (study.plant.G.is_integrating(cv))
      explained.head(samples_before(e)).setZero();
    loop.y_sim.row(cv) += explained.transpose();
    loop.untold.emplace_back(alike(e, columns).transpose());
  }
  return loop;
}

RecordPanel::RecordPanel(const RecordFrame& frame) : frame_(frame) {
  for (std::size_t m = 0; m < frame.methods.size(); ++m) {
    Group& group = needs_every_sample(frame, frame.methods[m]) ? groups_.back() : groups_.front();
    group.methods.push_back(frame.methods[m]);
    group.places.push_back(m);
  }
}

JudgedRecord RecordPanel::judge(const PlantRecord& record, const PlantRecord* healthy) {
  JudgedRecord judged{.loop = judged_loop(frame_, record), .said = {}};
  judged.benchmark = benchmark_of(frame_, record, judged.loop);
  const Eigen::Index first = judged.benchmark.first, count = judged.benchmark.second - first;
  const bool has_benchmark = count > 0;
  std::optional<AssessedLoop> good;
  if (has_benchmark)
    good = healthy == nullptr ? judged.loop : judged_loop(frame_, *healthy);
  judged.said.resize(frame_.methods.size());
  for (Group& group : groups_) {
    const bool closes = &group == &groups_.back();
    const Study& study = closes ? frame_.closed : frame_.as_kept;
    const auto seen = [&](const AssessedLoop& loop) {
      return closes ? without_gaps(loop, frame_.unjudged, frame_.fill) : loop;
    };
    const auto panel_with = [&](const AssessedLoop* of_benchmark) {
      AssessmentContext context{study, frame_.basis, frame_.factory,
                                of_benchmark != nullptr ? window_of(*of_benchmark, first, count)
                                                        : nominal_benchmark(study, frame_.basis)};
      learn_model(of_benchmark != nullptr ? *context.benchmark
                                          : without_moves(*context.benchmark, frame_.basis.point),
                  context);
      if (of_benchmark != nullptr && !closes)
        judged.habit = record_habit(context, frame_.model_error);
      return std::make_unique<MethodPanel>(study, std::move(context), group.methods);
    };
    if (group.methods.empty())
      continue;
    std::vector<AssessmentRecord> said;
    if (has_benchmark) {
      const AssessedLoop of_benchmark = seen(*good);
      said = panel_with(&of_benchmark)->assess(seen(judged.loop));
    } else {
      if (!group.panel)
        group.panel = panel_with(nullptr);
      said = group.panel->assess(seen(judged.loop));
    }
    for (std::size_t m = 0; m < said.size(); ++m) {
      add_costs(frame_, record, said[m]);
      judged.said[group.places[m]] = std::move(said[m]);
    }
  }
  return judged;
}

JudgedRecord judged_by(const RecordFrame& frame, std::vector<std::string> methods,
                       const PlantRecord& record) {
  RecordFrame asked = frame;
  asked.methods = std::move(methods);
  return RecordPanel(asked).judge(record);
}

}  // namespace mpm
