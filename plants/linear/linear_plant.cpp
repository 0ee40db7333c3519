#include "plants/linear/linear_plant.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "plants/linear/channel_table.hpp"

namespace mpm {
namespace {

void require_input_size(Eigen::Index found, Eigen::Index allowed) {
  if (found != allowed) {
    throw InputError("number of plant inputs", fmt::format("{}", found), fmt::format("{}", allowed));
  }
}

void require_steady_input(const ChannelTable& table, const Eigen::Ref<const Eigen::VectorXd>& input) {
  require_input_size(input.size(), table.input_count);
  for (Eigen::Index col = 0; col < input.size(); ++col) {
    if (!std::isfinite(input(col))) {
      throw InputError(fmt::format("steady value of input {}", col), fmt::format("{}", input(col)),
                       "finite numbers");
    }
  }
}

}  // namespace

LinearPlant::LinearPlant(const TransferMatrix& G, double sample_time, OutputSampling sampling)
    : table_(std::make_shared<const ChannelTable>(make_channel_table(G, sample_time, sampling))),
      input_count_(G.cols()),
      state_(Eigen::VectorXd::Zero(table_->state_per_input.size())),
      next_state_(Eigen::VectorXd::Zero(table_->max_order)),
      output_(Eigen::VectorXd::Zero(G.rows())),
      history_(Eigen::MatrixXd::Zero(G.cols(), 2 * table_->history_length)),
      newest_(table_->history_length),
      repeats_(table_->history_length),
      now_(Eigen::ArrayXd::Zero(table_->first_order.size())),
      forced_now_(now_),
      forced_previous_(now_),
      direct_(now_),
      ahead_(Eigen::MatrixXd::Zero(2 * table_->coefficient_count, G.rows())) {}

double LinearPlant::sample_time() const {
  return table_->sample_time;
}

void LinearPlant::reset(const Eigen::Ref<const Eigen::VectorXd>& steady_input) {
  require_steady_input(*table_, steady_input);
  for (Eigen::Index i = 0; i < state_.size(); ++i) {
    state_(i) = table_->state_per_input(i) * steady_input(table_->state_col[static_cast<std::size_t>(i)]);
  }
  history_.colwise() = steady_input;
  repeats_ = table_->history_length;
  read_inputs();
  forced_previous_ = table_->first_order.b_previous * now_;  // the input before is the same
  for (Eigen::Index row = 0; row < ahead_.rows(); ++row)
    hold_last_coefficients(steady_input, row);
  add_up_first_order([](const auto&, Eigen::Index) {});
  add_up_others();
}

PlantStatus LinearPlant::advance(const Eigen::Ref<const Eigen::VectorXd>& input) {
  require_input_size(input.size(), input_count_);
  if (table_->coefficient_count > 0)
    advance_coefficients(input);
  if (push_input(input))
    read_inputs();
  const double* newest = history_.data() + newest_ * input_count_;
  advance_first_order();
  advance_second_order(newest);
  advance_general(newest);
  add_up_others();
  return PlantStatus::ok;
}

/// Returns false if there is nothing to do: all stored inputs equal this one, as in most of a free response.
bool LinearPlant::push_input(const Eigen::Ref<const Eigen::VectorXd>& input) {
  const Eigen::Index length = table_->history_length;
  repeats_ = input == history_.col(newest_) ? repeats_ + 1 : 1;
  if (repeats_ > length) {
    return false;
  }
  newest_ = newest_ + 1 < 2 * length ? newest_ + 1 : length;
  history_.col(newest_) = input;
  history_.col(newest_ - length) = input;
  return true;
}

void LinearPlant::read_inputs() {
  const FirstOrderChannels& channels = table_->first_order;
  forced_previous_ = channels.b_previous * now_;
  const double* newest = history_.data() + newest_ * input_count_;
  for (const FirstOrderChannels::Place& place : channels.places)
    now_(place.index) = newest[place.input_now];
  forced_now_ = channels.b_now * now_;
  direct_ = channels.d * now_;
}

/// Sets the outputs, four at a time, to the sum of what these channels add to them. `update` is called for
/// the states of each column before they are read.
template <class Update>
void LinearPlant::add_up_first_order(const Update& update) {
  using Rows = FirstOrderChannels::Rows;
  const FirstOrderChannels& channels = table_->first_order;
  for (Eigen::Index row = 0; row < output_.size(); row += Rows::SizeAtCompileTime) {
    Rows y = Rows::Zero();
    for (Eigen::Index place = row; place < channels.size(); place += channels.rows) {
      Eigen::Map<Rows> x(state_.data() + place);
      update(x, place);
      y += x + Eigen::Map<const Rows>(direct_.data() + place);
    }
    std::copy_n(y.data(), std::min<Eigen::Index>(Rows::SizeAtCompileTime, output_.size() - row),
                output_.data() + row);
  }
}

void LinearPlant::advance_first_order() {
  const FirstOrderChannels& channels = table_->first_order;
  add_up_first_order([&](Eigen::Map<FirstOrderChannels::Rows>& x, Eigen::Index place) {
    const auto at_place = [place](const Eigen::ArrayXd& numbers) {
      return Eigen::Map<const FirstOrderChannels::Rows>(numbers.data() + place);
    };
    x = at_place(channels.a) * x + at_place(forced_now_) + at_place(forced_previous_);
  });
}

void LinearPlant::advance_second_order(const double* newest) {
  double* x = state_.data() + table_->first_order.size();
  for (const SecondOrderChannel& channel : table_->second_order) {
    const double now = newest[channel.wiring.input_now];
    const double previous = newest[channel.wiring.input_previous];
    const double x1 = x[0];
    const double x2 = x[1];
    x[0] = channel.a11 * x1 + channel.a12 * x2 + channel.b1_now * now + channel.b1_previous * previous;
    x[1] = channel.a21 * x1 + channel.a22 * x2 + channel.b2_now * now + channel.b2_previous * previous;
    x += 2;
  }
}

void LinearPlant::advance_general(const double* newest) {
  double* x = state_.data() + table_->first_order.size() + 2 * std::ssize(table_->second_order);
  for (const GeneralChannel& channel : table_->general) {
    const DiscreteChannel& model = channel.model;
    Eigen::Map<Eigen::VectorXd> state(x, model.A.rows());
    auto next = next_state_.head(state.size());
    next.noalias() = model.A * state;
    next += model.b_now * newest[channel.wiring.input_now] +
            model.b_previous * newest[channel.wiring.input_previous];
    state = next;
    x += state.size();
  }
}

/// Adds the effect of the change from the newest stored input, which is still u(k-1), from sample k + 1 on.
void LinearPlant::advance_coefficients(const Eigen::Ref<const Eigen::VectorXd>& input) {
  const Eigen::Index count = table_->coefficient_count;
  if (coming_ == count) {
    ahead_.topRows(count) = ahead_.bottomRows(count);
    coming_ = 0;
  }
  ++coming_;
  const Eigen::Index last = coming_ + count - 1;
  ahead_.row(last) = ahead_.row(last - 1);
  if (input == history_.col(newest_))
    return;
  for (const CoefficientChannel& channel : table_->coefficients)
    if (const double change = input(channel.col) - history_(channel.col, newest_); change != 0.0)
      ahead_.col(channel.row).segment(coming_, count - 1) += change * channel.step.head(count - 1);
  hold_last_coefficients(input, last);
}

void LinearPlant::hold_last_coefficients(const Eigen::Ref<const Eigen::VectorXd>& input, Eigen::Index at) {
  ahead_.row(at).setZero();
  for (const CoefficientChannel& channel : table_->coefficients)
    ahead_(at, channel.row) += channel.step(channel.step.size() - 1) * input(channel.col);
}

/// After an advance to sample k the newest input is u(k-1), so that input_now is the place of u(k - delay -
/// 1).
void LinearPlant::add_up_others() {
  const double* newest = history_.data() + newest_ * input_count_;
  const double* x = state_.data() + table_->first_order.size();
  for (const SecondOrderChannel& channel : table_->second_order) {
    output_(channel.wiring.row) +=
        channel.c1 * x[0] + channel.c2 * x[1] + channel.d * newest[channel.wiring.input_now];
    x += 2;
  }
  for (const GeneralChannel& channel : table_->general) {
    const Eigen::Map<const Eigen::VectorXd> state(x, channel.model.A.rows());
    output_(channel.wiring.row) +=
        channel.model.c.dot(state) + channel.model.d * newest[channel.wiring.input_now];
    x += state.size();
  }
  if (table_->coefficient_count > 0)
    output_ += ahead_.row(coming_).transpose();
}

Eigen::MatrixXd simulate(const TransferMatrix& G, double sample_time,
                         const Eigen::Ref<const Eigen::MatrixXd>& inputs, OutputSampling sampling) {
  require_input_size(inputs.rows(), G.cols());
  LinearPlant plant(G, sample_time, sampling);
  Eigen::MatrixXd outputs(G.rows(), inputs.cols());
  for (Eigen::Index k = 0; k < inputs.cols(); ++k) {
    outputs.col(k) = plant.output();
    plant.advance(inputs.col(k));
  }
  return outputs;
}

std::vector<Eigen::MatrixXd> step_response(const TransferMatrix& G, double sample_time,
                                           Eigen::Index samples) {
  if (samples < 0) {
    throw InputError("number of samples of a step response", fmt::format("{}", samples), "numbers >= 0");
  }
  const LinearPlant at_rest(G, sample_time);
  std::vector<Eigen::MatrixXd> responses;
  for (Eigen::Index col = 0; col < G.cols(); ++col) {
    LinearPlant plant = at_rest;
    const Eigen::VectorXd step = Eigen::VectorXd::Unit(G.cols(), col);
    Eigen::MatrixXd response(G.rows(), samples);
    for (Eigen::Index k = 0; k < samples; ++k) {
      plant.advance(step);
      response.col(k) = plant.output();
    }
    responses.push_back(std::move(response));
  }
  return responses;
}

}  // namespace mpm
