#include "analysis/methods/ours/mismatch_responses.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace mpm {
namespace {

// Within a cell of a grid m is taken as a straight line; the best sizes are looked at again with the exact m.
constexpr double kFactorCell = 0.15;  // of the logarithm of a factor
constexpr double kFinestShift = 0.25,
                 kGrowth = 1.5;  // first shift from 0 in samples, and ratio of the next ones
constexpr int kFewestCells = 2, kMostCells = 31;
constexpr double kSlopeStep = 1e-3;  // relative, or in samples

/// Sizes at equal ratios.
std::vector<double> factor_grid(double low, double high) {
  const int cells =
      std::clamp(static_cast<int>(std::ceil(std::log(high / low) / kFactorCell)), kFewestCells, kMostCells);
  std::vector<double> sizes;
  for (int i = 0; i < cells; ++i)
    sizes.push_back(low * std::pow(high / low, static_cast<double>(i) / cells));
  sizes.push_back(high);
  return sizes;
}

/// Shifts on both sides of 0, closest together around 0.
std::vector<double> shift_grid(double low, double high, double sample_time) {
  std::vector<double> sizes{low, high};
  if (low < 0.0 && high > 0.0)
    sizes.push_back(0.0);
  double step = kFinestShift * sample_time;
  for (double shift = step; shift < std::max(high, -low); step *= kGrowth, shift += step)
    for (const double size : {-shift, shift})
      if (low < size && size < high)
        sizes.push_back(size);
  std::sort(sizes.begin(), sizes.end());
  return sizes;
}

std::vector<double> grid_of(const SizePrior& prior, double sample_time) {
  const auto [low, high] = support(prior.size);
  if (prior.parameter == MismatchParameter::dead_time)
    return shift_grid(low, high, sample_time);
  return low > 0.0 ? factor_grid(low, high) : std::vector<double>{low, 0.5 * (low + high), high};
}

/// Adds the part of the channel that is not in its states: the sum of its pulse responses to u, and its last
/// coefficient for the input before the record.
void add_coefficients(const Eigen::VectorXd& step, const Eigen::Ref<const Eigen::RowVectorXd>& u,
                      double initial_u, Eigen::RowVectorXd& y) {
  if (step.size() == 0)
    return;
  Eigen::RowVectorXd pulses = step.transpose();
  pulses.tail(step.size() - 1) -= step.head(step.size() - 1).transpose();
  const double last = step(step.size() - 1);
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    const Eigen::Index count = std::min(k, step.size());
    y(k) += pulses.head(count).dot(u.segment(k - count, count).reverse()) +
            (last - (count > 0 ? step(count - 1) : 0.0)) * initial_u;
  }
}

}  // namespace

Eigen::RowVectorXd channel_response(const DiscreteChannel& channel,
                                    const Eigen::Ref<const Eigen::RowVectorXd>& u, double initial_u) {
  const Eigen::Index n = channel.A.rows();
  const auto input = [&](Eigen::Index k) { return k < 0 ? initial_u : u(k); };
  Eigen::RowVectorXd y(u.size());
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  if (n > 0 && initial_u != 0.0)
    x = (Eigen::MatrixXd::Identity(n, n) - channel.A)
            .partialPivLu()
            .solve((channel.b_now + channel.b_previous) * initial_u);
  if (n == 1) {
    const double a = channel.A(0, 0), b = channel.b_now(0), before = channel.b_previous(0), c = channel.c(0);
    double state = x(0);
    for (Eigen::Index k = 0; k < y.size(); ++k) {
      const double older = input(k - channel.delay - 1);
      y(k) = c * state + channel.d * older;
      state = a * state + b * input(k - channel.delay) + before * older;
    }
    add_coefficients(channel.step, u, initial_u, y);
    return y;
  }
  Eigen::VectorXd next(n);
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    const double older = input(k - channel.delay - 1);
    y(k) = (n > 0 ? channel.c.dot(x) : 0.0) + channel.d * older;
    next.noalias() = channel.A * x;
    next += channel.b_now * input(k - channel.delay) + channel.b_previous * older;
    x.swap(next);
  }
  add_coefficients(channel.step, u, initial_u, y);
  return y;
}

MismatchResponses::MismatchResponses(const TransferFunction& nominal, double sample_time,
                                     const SizePrior& prior)
    : prior_(prior),
      nominal_(nominal),
      sample_time_(sample_time),
      nominal_channel_(discretise(nominal_, sample_time_)),
      sizes_(grid_of(prior, sample_time_)) {
  for (const double size : sizes_)
    if (!is_linear())
      channels_.push_back(channel_at(size));
}

Eigen::MatrixXd MismatchResponses::on_grid(const Eigen::Ref<const Eigen::RowVectorXd>& u,
                                           double initial_u) const {
  const Eigen::RowVectorXd nominal = channel_response(nominal_channel_, u, initial_u);
  if (is_linear())
    return nominal;
  Eigen::MatrixXd responses(static_cast<Eigen::Index>(channels_.size()), u.size());
  for (Eigen::Index i = 0; i < responses.rows(); ++i)
    responses.row(i) = channel_response(channels_[static_cast<std::size_t>(i)], u, initial_u) - nominal;
  return responses;
}

Eigen::RowVectorXd MismatchResponses::slope(double size, const Eigen::Ref<const Eigen::RowVectorXd>& u,
                                            double initial_u) const {
  if (is_linear())
    return channel_response(nominal_channel_, u, initial_u);
  const double step =
      kSlopeStep * (prior_.parameter == MismatchParameter::dead_time ? sample_time_ : std::abs(size));
  const double other = size + step > sizes_.back() ? size - step : size + step;
  return (channel_response(channel_at(other), u, initial_u) -
          channel_response(channel_at(size), u, initial_u)) /
         (other - size);
}

Eigen::RowVectorXd MismatchResponses::at(double size, const Eigen::Ref<const Eigen::RowVectorXd>& u,
                                         double initial_u) const {
  const Eigen::RowVectorXd nominal = channel_response(nominal_channel_, u, initial_u);
  if (is_linear())
    return (size - 1.0) * nominal;
  return channel_response(channel_at(size), u, initial_u) - nominal;
}

DiscreteChannel MismatchResponses::channel_at(double size) const {
  // By rounding, the ends of a support may lie beyond what is possible.
  const double possible =
      prior_.parameter == MismatchParameter::dead_time ? std::max(size, -nominal_.dead_time()) : size;
  const Mismatch mismatch{0, 0, prior_.parameter, possible};
  return discretise(with_mismatches(TransferMatrix{{nominal_}}, {mismatch})(0, 0), sample_time_);
}

}  // namespace mpm
