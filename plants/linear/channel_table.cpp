#include "plants/linear/channel_table.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/LU>
#include <Eigen/SVD>

namespace mpm {
namespace {

/// A channel on its way into the table.
struct Entry {
  DiscreteChannel model;
  ChannelWiring wiring;
  Eigen::VectorXd state_per_input;
};

ChannelWiring make_wiring(Eigen::Index row, Eigen::Index col, Eigen::Index input_count, int delay) {
  const Eigen::Index now = col - input_count * delay;
  return {row, col, now, now - input_count};
}

/// The x of an integrating channel with x + r v = A x + b_now + b_previous and c x + d = 0, v = A v: its rate
/// is steady, and its output is 0.
Eigen::VectorXd ramp_state_per_input(const DiscreteChannel& model) {
  const Eigen::Index n = model.A.rows();
  const Eigen::MatrixXd change = model.A - Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd equations = Eigen::MatrixXd::Zero(n + 1, n + 1);
  equations.topLeftCorner(n, n) = change;
  equations.topRightCorner(n, 1) =
      -Eigen::JacobiSVD<Eigen::MatrixXd>(change, Eigen::ComputeFullV).matrixV().col(n - 1);
  equations.bottomLeftCorner(1, n) = model.c;
  Eigen::VectorXd right(n + 1);
  const double beside = model.step.size() > 0 ? model.step(model.step.size() - 1) : 0.0;
  right << -(model.b_now + model.b_previous), -model.d - beside;
  return equations.fullPivLu().solve(right).head(n);
}

/// The fixed point of x = A x + b_now + b_previous.
Eigen::VectorXd steady_state_per_input(const DiscreteChannel& model) {
  const Eigen::Index n = model.A.rows();
  if (n == 0) {
    return Eigen::VectorXd(0);
  }
  const Eigen::MatrixXd difference = Eigen::MatrixXd::Identity(n, n) - model.A;
  return difference.fullPivLu().solve(model.b_now + model.b_previous);
}

std::vector<Entry> discretise_channels(const TransferMatrix& G, double sample_time, OutputSampling sampling) {
  std::vector<Entry> entries;
  for (Eigen::Index col = 0; col < G.cols(); ++col) {
    for (Eigen::Index row = 0; row < G.rows(); ++row) {
      const TransferFunction& channel = G(row, col);
      if (channel.is_zero()) {
        continue;
      }
      DiscreteChannel model = discretise(channel, sample_time, sampling);
      const ChannelWiring wiring = make_wiring(row, col, G.cols(), model.delay);
      Eigen::VectorXd steady =
          channel.is_integrating() ? ramp_state_per_input(model) : steady_state_per_input(model);
      entries.push_back({std::move(model), wiring, std::move(steady)});
    }
  }
  return entries;
}

/// Places the channels with at most one pole, with their steady states and the inputs that drive them.
void place_first_order(ChannelTable& table, const std::vector<Entry>& entries) {
  std::vector<Eigen::Index> filled(static_cast<std::size_t>(table.output_count), 0);  // columns, by row
  const auto next_column = [&](const Entry& entry) {
    return filled[static_cast<std::size_t>(entry.wiring.row)]++;
  };
  Eigen::Index columns = 0;
  for (const Entry& entry : entries)
    if (entry.model.A.rows() <= 1)
      columns = std::max(columns, next_column(entry) + 1);

  FirstOrderChannels& channels = table.first_order;
  constexpr Eigen::Index kRows = FirstOrderChannels::Rows::SizeAtCompileTime;
  channels.rows = (table.output_count + kRows - 1) / kRows * kRows;
  channels.a.setZero(channels.rows * columns);
  channels.b_now = channels.b_previous = channels.d = channels.a;
  table.state_per_input.setZero(channels.size());
  table.state_col.assign(static_cast<std::size_t>(channels.size()), 0);
  std::fill(filled.begin(), filled.end(), 0);
  for (const Entry& entry : entries) {
    const DiscreteChannel& model = entry.model;
    if (model.A.rows() > 1)
      continue;
    const Eigen::Index place = next_column(entry) * channels.rows + entry.wiring.row;
    channels.places.push_back({place, entry.wiring.input_now});
    channels.d(place) = model.d;
    table.state_col[static_cast<std::size_t>(place)] = entry.wiring.col;
    if (model.A.rows() == 0)
      continue;
    const double c = model.c(0);
    channels.a(place) = model.A(0, 0);
    channels.b_now(place) = c * model.b_now(0);
    channels.b_previous(place) = c * model.b_previous(0);
    table.state_per_input(place) = c * entry.state_per_input(0);
  }
}

SecondOrderChannel second_order_channel(const Entry& entry) {
  const DiscreteChannel& m = entry.model;
  return {m.A(0, 0),       m.A(0, 1),       m.A(1, 0), m.A(1, 1), m.b_now(0), m.b_now(1),
          m.b_previous(0), m.b_previous(1), m.c(0),    m.c(1),    m.d,        entry.wiring};
}

void append_states(ChannelTable& table, const Eigen::VectorXd& state_per_input, Eigen::Index col) {
  const Eigen::Index old_size = table.state_per_input.size();
  table.state_per_input.conservativeResize(old_size + state_per_input.size());
  table.state_per_input.tail(state_per_input.size()) = state_per_input;
  table.state_col.insert(table.state_col.end(), static_cast<std::size_t>(state_per_input.size()), col);
}

void place_coefficients(ChannelTable& table, const std::vector<Entry>& entries) {
  for (const Entry& entry : entries)
    table.coefficient_count = std::max(table.coefficient_count, entry.model.step.size());
  for (const Entry& entry : entries)
    if (const Eigen::VectorXd& step = entry.model.step; step.size() > 0) {
      Eigen::VectorXd values = Eigen::VectorXd::Constant(table.coefficient_count, step(step.size() - 1));
      values.head(step.size()) = step;
      table.coefficients.push_back({entry.wiring.row, entry.wiring.col, std::move(values)});
    }
}

/// Three passes, because the states stand in the order of the lists.
void sort_into(ChannelTable& table, const std::vector<Entry>& entries) {
  place_first_order(table, entries);
  for (const Entry& entry : entries) {
    if (entry.model.A.rows() == 2) {
      table.second_order.push_back(second_order_channel(entry));
      append_states(table, entry.state_per_input, entry.wiring.col);
    }
  }
  for (const Entry& entry : entries) {
    if (entry.model.A.rows() > 2) {
      table.general.push_back({entry.model, entry.wiring});
      append_states(table, entry.state_per_input, entry.wiring.col);
    }
  }
}

}  // namespace

ChannelTable make_channel_table(const TransferMatrix& G, double sample_time, OutputSampling sampling) {
  require_sample_time(sample_time);
  ChannelTable table;
  table.output_count = G.rows();
  table.input_count = G.cols();
  table.sample_time = sample_time;

  const std::vector<Entry> entries = discretise_channels(G, sample_time, sampling);
  int max_delay = 0;
  for (const Entry& entry : entries) {
    max_delay = std::max(max_delay, entry.model.delay);
    table.max_order = std::max(table.max_order, entry.model.A.rows());
  }
  table.history_length = max_delay + 2;
  place_coefficients(table, entries);
  sort_into(table, entries);
  return table;
}

}  // namespace mpm
