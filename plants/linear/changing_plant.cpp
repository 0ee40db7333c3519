#include "plants/linear/changing_plant.hpp"

#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {
namespace {

/// The factor f of H = f H1.
double gain_factor(const TransferFunction& before, const TransferFunction& after) {
  if (before.is_integrating() || after.is_integrating() || before.is_zero() || after.is_zero())
    return 1.0;
  const double gain = before.static_gain();
  const double factor = after.static_gain() / gain;
  return gain != 0.0 && factor != 0.0 ? factor : 1.0;
}

/// G and H1 of each channel that changes, one below the other.
template <class Channels>
TransferMatrix both_of(const Channels& channels, const TransferMatrix& before, const TransferMatrix& after) {
  const auto count = static_cast<Eigen::Index>(channels.size());
  TransferMatrix both(2 * count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& [row, col, factor] = channels[static_cast<std::size_t>(i)];
    both(2 * i, i) = before(row, col);
    both(2 * i + 1, i) = after(row, col).with_gain_scaled(1.0 / factor);
  }
  return both;
}

template <class Channels>
TransferMatrix without(const Channels& channels, TransferMatrix plant) {
  for (const auto& channel : channels)
    plant(channel.row, channel.col) = TransferFunction::zero();
  return plant;
}

template <class Channels>
Channels changed_channels(const TransferMatrix& before, const TransferMatrix& after) {
  if (before.rows() != after.rows() || before.cols() != after.cols())
    throw InputError("plant after a change", fmt::format("{} x {} channels", after.rows(), after.cols()),
                     fmt::format("{} x {}, as before", before.rows(), before.cols()));
  Channels channels;
  for (Eigen::Index row = 0; row < before.rows(); ++row)
    for (Eigen::Index col = 0; col < before.cols(); ++col)
      if (!(before(row, col) == after(row, col)))
        channels.push_back({row, col, gain_factor(before(row, col), after(row, col))});
  return channels;
}

Eigen::VectorXd checked_share(Eigen::VectorXd share) {
  if (share.size() == 0 || !(share.array() >= 0.0 && share.array() <= 1.0).all())
    throw InputError("share of a change", share.size() == 0 ? "none" : "a number outside [0, 1]",
                     "one number from 0 to 1 a sample");
  return share;
}

}  // namespace

ChangingPlant::ChangingPlant(const TransferMatrix& before, const TransferMatrix& after, double sample_time,
                             Eigen::VectorXd share, OutputSampling sampling)
    : share_(checked_share(std::move(share))),
      channels_(changed_channels<std::vector<Channel>>(before, after)),
      unchanged_(without(channels_, before), sample_time, sampling),
      changing_(both_of(channels_, before, after), sample_time, sampling),
      w_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(channels_.size()))),
      output_(Eigen::VectorXd::Zero(before.rows())) {}

void ChangingPlant::reset(const Eigen::Ref<const Eigen::VectorXd>& steady_input) {
  sample_ = 0;
  unchanged_.reset(steady_input);
  weigh(steady_input);
  changing_.reset(w_);
  measure();
}

PlantStatus ChangingPlant::advance(const Eigen::Ref<const Eigen::VectorXd>& input) {
  unchanged_.advance(input);
  weigh(input);
  changing_.advance(w_);
  ++sample_;
  measure();
  return PlantStatus::ok;
}

void ChangingPlant::weigh(const Eigen::Ref<const Eigen::VectorXd>& input) {
  const double a = share();
  for (std::size_t i = 0; i < channels_.size(); ++i)
    w_(static_cast<Eigen::Index>(i)) = (1.0 + (channels_[i].gain_factor - 1.0) * a) * input(channels_[i].col);
}

void ChangingPlant::measure() {
  const double a = share();
  output_ = unchanged_.output();
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const auto place = static_cast<Eigen::Index>(2 * i);
    output_(channels_[i].row) += (1.0 - a) * changing_.output()(place) + a * changing_.output()(place + 1);
  }
}

}  // namespace mpm
