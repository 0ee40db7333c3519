#include "analysis/methods/mismatch_responses.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace mpm {
namespace {

// Widths of the cells of a grid: of the logarithm of a factor, and of a shift in samples. Within a cell m is
// taken as a straight line; the best cells are looked at again with the exact m.
constexpr double kFactorCell = 0.15, kShiftCell = 0.5;
constexpr int kMostCells = 16;
constexpr double kSlopeStep = 1e-3;  // relative, or in samples

int cells_of(double range, double cell) {
  return std::clamp(static_cast<int>(std::ceil(range / cell)), 2, kMostCells);
}

/// Sizes at the same distance, or at the same ratio where the size is a factor.
std::vector<double> grid_of(const SizePrior& prior, double sample_time) {
  const auto [low, high] = support(prior.size);
  const bool ratio = low > 0.0 && prior.parameter != MismatchParameter::dead_time;
  const int cells =
      ratio ? cells_of(std::log(high / low), kFactorCell) : cells_of((high - low) / sample_time, kShiftCell);
  std::vector<double> sizes;
  for (int i = 0; i <= cells; ++i) {
    const double share = static_cast<double>(i) / cells;
    sizes.push_back(ratio ? low * std::pow(high / low, share) : low + share * (high - low));
  }
  sizes.back() = high;
  return sizes;
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
  return y;
}

MismatchResponses::MismatchResponses(const Study& study, const SizePrior& prior)
    : prior_(prior),
      nominal_(study.plant.G(prior.channel.cv, prior.channel.mv)),
      sample_time_(study.controller.sample_time),
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
  // The ends of a support may lie beyond what is possible by rounding.
  const double possible =
      prior_.parameter == MismatchParameter::dead_time ? std::max(size, -nominal_.dead_time()) : size;
  const Mismatch mismatch{0, 0, prior_.parameter, possible};
  return discretise(with_mismatches(TransferMatrix{{nominal_}}, {mismatch})(0, 0), sample_time_);
}

}  // namespace mpm
