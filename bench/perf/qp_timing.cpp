#include "bench/perf/qp_timing.hpp"

#include <algorithm>

#include "analysis/statistics/quantile.hpp"
#include "bench/perf/short_clock.hpp"

namespace mpm {
namespace {

double quantile(std::vector<double> values, double probability) {
  std::sort(values.begin(), values.end());
  return sorted_quantile(values, probability);
}

}  // namespace

QpTimes program_times(const std::vector<std::vector<double>>& microseconds) {
  std::vector<double> typical;
  for (const std::vector<double>& passes : microseconds)
    typical.push_back(quantile(passes, 0.5));
  return {.median = quantile(typical, 0.5), .p99 = quantile(typical, 0.99), .max = quantile(typical, 1.0)};
}

QpTiming::QpTiming(const QpSequence& sequence, const QpSolverFactory& factory, StartOfSolve start)
    : sequence_(sequence),
      solver_(factory(sequence.structure)),
      data_(sequence.data.front()),
      start_(start),
      microseconds_(sequence.data.size()) {}

double QpTiming::pass() {
  double seconds = 0.0;
  quality_ = {};
  solver_->reset();
  for (std::size_t k = 0; k < sequence_.data.size(); ++k) {
    if (start_ == StartOfSolve::cold)
      solver_->reset();
    data_ = sequence_.data[k];  // in the cache, as after a controller has written it
    const double begin = short_seconds();
    const QpResult& result = solver_->solve(data_);
    const double elapsed = short_seconds() - begin;
    seconds += elapsed;
    microseconds_[k].push_back(1e6 * elapsed);
    quality_.iterations += result.iterations;
    if (result.status == QpStatus::solved)
      quality_.kkt_residual = std::max(quality_.kkt_residual, result.kkt_residual);
    else
      ++(result.status == QpStatus::infeasible ? quality_.infeasible : quality_.not_solved);
  }
  quality_.iterations /= static_cast<double>(sequence_.data.size());
  return seconds;
}

QpTimes QpTiming::times() const {
  QpTimes result = quality_;
  const QpTimes times = program_times(microseconds_);
  result.median = times.median;
  result.p99 = times.p99;
  result.max = times.max;
  return result;
}

}  // namespace mpm
