#pragma once

#include <string>

#include "plants/linear/transfer_function.hpp"
#include "scenarios/random/distribution.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {

/// Longest dead time and longest step coefficients that a study may have, in samples. It limits the memory
/// that a mistake can cost.
inline constexpr double kMaxDeadTimeSamples = 10000;

/// The keys of a transfer function from `input` to a CV, which read_transfer_function() reads. `poles` says
/// where its poles may lie.
OptionKeys transfer_function_keys(const std::string& input, const std::string& poles);

/// A transfer function read from a table.
struct WrittenTransferFunction {
  TransferFunction function;
  double step_error = 0.0;  ///< largest error of its parameters in the step coefficients, as a share of the
                            ///< largest coefficient
};

/// Reads the transfer function in these keys of a table.
WrittenTransferFunction read_transfer_function(const TomlTable& table);

/// The number of poles at 0 that a channel may have beside those with negative real parts.
enum class PolesAtOrigin { none, one };

/// Refuses an unstable channel of a plant: y_sim = G0 u of (6.4) diverges for an unstable model, and a plant
/// starts in a steady state. One pole at 0 makes a CV integrate.
void refuse_unstable(const TomlTable& table, const TransferFunction& channel, PolesAtOrigin allowed);

/// Refuses a disturbance model whose output grows by itself: its poles may lie at 0, but not to the right of
/// it.
void refuse_growing(const TomlTable& table, const TransferFunction& Gd);

/// Refuses a dead time, which is the value of `key`, and step coefficients that are longer than
/// kMaxDeadTimeSamples.
void refuse_long_memory(const TomlTable& table, const std::string& key, const TransferFunction& channel,
                        double sample_time);

/// The largest draws that change a channel.
struct LongestDraws {
  double time_factor = 1.0, least_time_factor = 1.0;
  double dead_time_factor = 1.0, dead_time_shift = 0.0;
  double lag = 0.0;  ///< time constant of a further lag
};

/// Returns the largest draw; for a normal distribution, which has none, ten standard deviations above the
/// mean.
double largest_draw(const Distribution& draws);

/// Refuses `draws` of `key` with which `channel`, called `name`, keeps more than kMaxDelay samples of its
/// input or coefficients of its step response. `longest` has the largest of these draws and of those drawn
/// with them.
void refuse_long_draws(const TomlTable& table, const std::string& key, const Distribution& draws,
                       const TransferFunction& channel, const std::string& name, const LongestDraws& longest,
                       double sample_time);

}  // namespace mpm
