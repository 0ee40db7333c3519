#include "scenarios/loop/record_rows.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace mpm {
namespace {

using Signal = Eigen::Ref<const Eigen::RowVectorXd>;

/// Between samples a signal goes this share of the way to its next value: it is held, or a straight line.
constexpr double kHeld = 0.0, kLine = 1.0;

double sample_of(const Signal& signal, Eigen::Index k) {
  return signal(std::clamp<Eigen::Index>(k, 0, signal.size() - 1));
}

/// The value at time t, in samples, within sample k. The mean over a part of the sample is the value in the
/// middle of that part.
double value_in(const Signal& signal, Eigen::Index k, double t, double share) {
  const double a = sample_of(signal, k);
  return a + share * (t - static_cast<double>(k)) * (sample_of(signal, k + 1) - a);
}

double value_at(const Signal& signal, double t, double share) {
  return value_in(signal, static_cast<Eigen::Index>(std::floor(t)), t, share);
}

/// The mean over [t - 1, t), which lies in two samples.
double mean_before(const Signal& signal, double t, double share) {
  const double border = std::floor(t - 1.0) + 1.0;
  const auto k = static_cast<Eigen::Index>(border);
  return (border - (t - 1.0)) * value_in(signal, k - 1, (border + t - 1.0) / 2.0, share) +
         (t - border) * value_in(signal, k, (border + t) / 2.0, share);
}

Eigen::RowVectorXd rows_between(const RowTime& time, const Signal& signal, double share) {
  Eigen::RowVectorXd rows(signal.size());
  for (Eigen::Index k = 0; k < rows.size(); ++k) {
    const double t = static_cast<double>(k) + time.shift;
    rows(k) =
        time.sampling == OutputSampling::average ? mean_before(signal, t, share) : value_at(signal, t, share);
  }
  return rows;
}

}  // namespace

Eigen::Index RowTime::sample() const {
  return static_cast<Eigen::Index>(std::ceil(shift));
}

double RowTime::delay() const {
  return std::ceil(shift) - shift;
}

RowTime row_time(const RecordOptions& record, VariableSort sort, Eigen::Index variable) {
  const std::vector<double>& shifts = record.shifts_of(sort);
  return {sort == VariableSort::cv ? record.sampling : OutputSampling::snapshot,
          shifts.empty() ? 0.0 : shifts[static_cast<std::size_t>(variable)]};
}

Eigen::RowVectorXd rows_of(const RowTime& time, const Eigen::Ref<const Eigen::RowVectorXd>& at_samples,
                           Eigen::Index rows) {
  Eigen::RowVectorXd shown(rows);
  for (Eigen::Index k = 0; k < rows; ++k)
    shown(k) = sample_of(at_samples, k + time.sample());
  return shown;
}

Eigen::RowVectorXd rows_of_held(const RowTime& time, const Eigen::Ref<const Eigen::RowVectorXd>& signal) {
  return rows_between(time, signal, kHeld);
}

Eigen::RowVectorXd rows_of_line(const RowTime& time, const Eigen::Ref<const Eigen::RowVectorXd>& signal) {
  return rows_between(time, signal, kLine);
}

Eigen::RowVectorXd late_by(const Eigen::Ref<const Eigen::RowVectorXd>& signal, double s) {
  return rows_of_line({OutputSampling::snapshot, -s}, signal);
}

}  // namespace mpm
