#include "scenarios/loop/historian.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/non_finite.hpp"
#include "scenarios/loop/record_rows.hpp"
#include "scenarios/loop/signals.hpp"
#include "scenarios/random/random_stream.hpp"

namespace mpm {
namespace {

/// Takes three draws for each sample, whether it is an outlier or not: another share leaves all other
/// outliers as they are.
void add_outliers(const Study& study, std::int64_t index, Eigen::MatrixXd& y) {
  RandomStream stream = experiment_stream(study, index, StreamId::outliers);
  for (Eigen::Index k = 0; k < y.cols(); ++k)
    for (Eigen::Index cv = 0; cv < y.rows(); ++cv) {
      const bool outlier = stream.uniform() < study.record.outlier_share;
      const double size = study.record.outlier_size.sample(stream);
      const double sign = stream.uniform() < 0.5 ? -1.0 : 1.0;
      if (outlier)
        y(cv, k) += sign * size * study.simulation.noise_standard_deviation(cv);
    }
}

void quantise(const Study& study, Eigen::MatrixXd& y) {
  for (Eigen::Index cv = 0; cv < y.rows(); ++cv) {
    const double step = study.record.quantisation * study.simulation.noise_standard_deviation(cv);
    y.row(cv) = (step * (y.row(cv).array() / step).round()).matrix();
  }
}

/// The spells of a Markov chain of two states. Their mean length is `length` samples and they take `share` of
/// the samples in the long run, which is also the probability that the record begins within a spell.
std::vector<bool> spells(double share, double length, Eigen::Index samples, RandomStream& stream) {
  const double ends = 1.0 / length;
  const double begins = share * ends / (1.0 - share);
  std::vector<bool> within(static_cast<std::size_t>(samples));
  for (std::size_t k = 0; k < within.size(); ++k)
    within[k] = stream.uniform() < (k == 0 ? share : within[k - 1] ? 1.0 - ends : begins);
  return within;
}

void make_gaps(const Study& study, std::int64_t index, Eigen::MatrixXd& y) {
  RandomStream stream = experiment_stream(study, index, StreamId::missing);
  for (Eigen::Index cv = 0; cv < y.rows(); ++cv) {
    const std::vector<bool> missing =
        spells(study.record.missing_share, study.record.missing_length, y.cols(), stream);
    for (Eigen::Index k = 0; k < y.cols(); ++k)
      if (missing[static_cast<std::size_t>(k)])
        y(cv, k) = kNaN;
  }
}

/// If a record begins with bad values, they are stuck at its first sample.
void make_bad(const Study& study, std::int64_t index, Eigen::MatrixXd& y) {
  const RecordOptions& record = study.record;
  RandomStream stream = experiment_stream(study, index, StreamId::bad_values);
  for (Eigen::Index cv = 0; cv < y.rows(); ++cv) {
    const std::vector<bool> bad = spells(record.bad_share, record.bad_length, y.cols(), stream);
    const double off_scale = record.bad_size * study.simulation.noise_standard_deviation(cv);
    double good = y(cv, 0);
    for (Eigen::Index k = 0; k < y.cols(); ++k)
      if (!bad[static_cast<std::size_t>(k)])
        good = y(cv, k);
      else
        y(cv, k) = record.bad_quality ? kNaN : record.bad_value == BadValue::stuck ? good : off_scale;
  }
}

/// Applies `passed`, with `deviation` standard deviations of the noise, to each run of samples between two
/// gaps.
void pass_runs(const Study& study, double deviation,
               Eigen::RowVectorXd (*passed)(const Eigen::Ref<const Eigen::RowVectorXd>&, double),
               Eigen::MatrixXd& y) {
  for (Eigen::Index cv = 0; cv < y.rows(); ++cv)
    for (Eigen::Index from = 0; from < y.cols();) {
      Eigen::Index to = from;
      while (to < y.cols() && !std::isnan(y(cv, to)))
        ++to;
      if (to > from)
        y.row(cv).segment(from, to - from) = passed(
            y.row(cv).segment(from, to - from), deviation * study.simulation.noise_standard_deviation(cv));
      from = to + 1;
    }
}

/// Puts the samples between `a` and `b` onto the straight line from sample `a` to sample `b`.
void draw_line(Eigen::RowVectorXd& signal, Eigen::Index a, Eigen::Index b) {
  for (Eigen::Index k = a + 1; k < b; ++k)
    signal(k) = signal(a) + (signal(b) - signal(a)) * static_cast<double>(k - a) / static_cast<double>(b - a);
}

}  // namespace

Eigen::RowVectorXd compressed(const Eigen::Ref<const Eigen::RowVectorXd>& signal, double deviation) {
  Eigen::RowVectorXd read = signal;
  Eigen::Index archived = 0;
  double lowest = -kInfinity;  // slopes from the archived point that fit all samples since within deviation
  double highest = kInfinity;
  for (Eigen::Index k = 1; k < signal.size(); ++k) {
    double distance = static_cast<double>(k - archived);
    const double slope = (signal(k) - signal(archived)) / distance;
    if (slope < lowest || slope > highest) {
      draw_line(read, archived, k - 1);
      archived = k - 1;
      lowest = -kInfinity;
      highest = kInfinity;
      distance = 1.0;
    }
    lowest = std::max(lowest, (signal(k) - deviation - signal(archived)) / distance);
    highest = std::min(highest, (signal(k) + deviation - signal(archived)) / distance);
  }
  draw_line(read, archived, signal.size() - 1);
  return read;
}

Eigen::RowVectorXd reported(const Eigen::Ref<const Eigen::RowVectorXd>& signal, double deviation) {
  Eigen::RowVectorXd read = signal;
  for (Eigen::Index k = 1; k < read.size(); ++k)
    if (std::abs(signal(k) - read(k - 1)) <= deviation)
      read(k) = read(k - 1);
  return read;
}

Eigen::RowVectorXd filled(Eigen::RowVectorXd signal, GapFill fill) {
  Eigen::Index before = -1;  // the last sample that is no gap
  for (Eigen::Index k = 0; k < signal.size() && fill != GapFill::none; ++k) {
    if (std::isnan(signal(k)))
      continue;
    if (before < 0)
      signal.head(k).setConstant(signal(k));
    else if (fill == GapFill::linear)
      draw_line(signal, before, k);
    else
      signal.segment(before + 1, k - before - 1).setConstant(signal(before));
    before = k;
  }
  if (before >= 0)
    signal.tail(signal.size() - before - 1).setConstant(signal(before));
  return signal;
}

namespace {

/// Shifts MVs or MDs, which are held from sample to sample.
void shift_held(const RecordOptions& record, VariableSort sort, Eigen::MatrixXd& signals) {
  for (Eigen::Index i = 0; i < signals.rows() && !record.shifts_of(sort).empty(); ++i)
    signals.row(i) = rows_of_held(row_time(record, sort, i), Eigen::RowVectorXd(signals.row(i)));
}

}  // namespace

Trajectory recorded(const Study& study, std::int64_t index, Trajectory loop) {
  const RecordOptions& record = study.record;
  if (loop.y_sampled.size() > 0)
    loop.y = std::move(loop.y_sampled);
  shift_held(record, VariableSort::mv, loop.u);
  shift_held(record, VariableSort::md, loop.d);
  if (record.outlier_share > 0.0)
    add_outliers(study, index, loop.y);
  if (record.quantisation > 0.0)
    quantise(study, loop.y);
  if (record.bad_share > 0.0)
    make_bad(study, index, loop.y);
  if (record.missing_share > 0.0)
    make_gaps(study, index, loop.y);
  if (record.exception > 0.0)
    pass_runs(study, record.exception, reported, loop.y);
  if (record.compression > 0.0)
    pass_runs(study, record.compression, compressed, loop.y);
  if (record.missing_share > 0.0 || (record.bad_share > 0.0 && record.bad_quality))
    for (Eigen::Index cv = 0; cv < loop.y.rows(); ++cv)
      loop.y.row(cv) = filled(loop.y.row(cv), record.fill);
  return loop;
}

}  // namespace mpm
