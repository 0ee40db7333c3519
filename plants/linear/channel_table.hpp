#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "plants/linear/transfer_matrix.hpp"
#include "plants/linear/zero_order_hold.hpp"

namespace mpm {

/// Where a channel reads its input from and where its output goes.
struct ChannelWiring {
  Eigen::Index row = 0;               ///< output
  Eigen::Index col = 0;               ///< input
  std::ptrdiff_t input_now = 0;       ///< place of u(k - delay), counted from the newest input vector
  std::ptrdiff_t input_previous = 0;  ///< place of u(k - delay - 1)
};

/// The channels with at most one pole, side by side: column c holds the c-th of these channels of each
/// output, in the order of the inputs, and zeros for an output that has fewer. Four rows of all columns then
/// give four outputs. The state of each channel is its own output without direct effect (c = 1).
struct FirstOrderChannels {
  using Rows = Eigen::Array4d;
  struct Place {
    Eigen::Index index;  ///< in the arrays, which have one column after the other
    std::ptrdiff_t input_now;
  };

  Eigen::Index rows = 0;                   ///< length of a column: outputs, padded to a multiple of four
  Eigen::ArrayXd a, b_now, b_previous, d;  ///< rows x columns
  std::vector<Place> places;               ///< one for each channel

  Eigen::Index size() const { return a.size(); }
};

/// A channel with two poles, symbols as in DiscreteChannel.
struct SecondOrderChannel {
  double a11 = 0, a12 = 0, a21 = 0, a22 = 0;
  double b1_now = 0, b2_now = 0;
  double b1_previous = 0, b2_previous = 0;
  double c1 = 0, c2 = 0;
  double d = 0;
  ChannelWiring wiring;
};

/// A channel with three or more poles.
struct GeneralChannel {
  DiscreteChannel model;
  ChannelWiring wiring;
};

/// The data, beyond its state, of a channel that has step coefficients.
struct CoefficientChannel {
  Eigen::Index row, col;
  Eigen::VectorXd step;  ///< as in DiscreteChannel; the last value fills it up to the longest
};

/// The discretised non-zero channels of a transfer matrix, sorted by number of poles. Immutable once built,
/// so that all copies of a plant share one.
///
/// The states of all channels stand in one vector: first those of `first_order` (one each, zeros too), then
/// those of `second_order` (two each), then those of `general`, in the order of these lists.
struct ChannelTable {
  Eigen::Index output_count = 0;
  Eigen::Index input_count = 0;
  double sample_time = 0;
  int history_length = 0;  ///< input vectors that must be kept: the largest delay + 2

  FirstOrderChannels first_order;
  std::vector<SecondOrderChannel> second_order;
  std::vector<GeneralChannel> general;
  std::vector<CoefficientChannel> coefficients;
  Eigen::Index coefficient_count = 0;  ///< length of the longest step response

  /// Steady state for a unit input. For an integrating channel, the state in which its rate is steady and its
  /// output is 0.
  Eigen::VectorXd state_per_input;
  std::vector<Eigen::Index> state_col;  ///< input that drives each state
  Eigen::Index max_order = 0;
};

/// Discretises every non-zero channel. Errors: as discretise().
ChannelTable make_channel_table(const TransferMatrix& G, double sample_time,
                                OutputSampling sampling = OutputSampling::snapshot);

}  // namespace mpm
