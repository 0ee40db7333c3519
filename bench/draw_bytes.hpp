#pragma once

#include <optional>
#include <type_traits>
#include <variant>

#include "bench/byte_stream.hpp"
#include "scenarios/draw.hpp"

// The faults of an experiment as bytes (bench/byte_stream.hpp).

namespace mpm {

/// A transfer function, which has no empty form to read into.
template <class Stream, class Optional>
void transfer_function(Stream& stream, Optional& function) {
  bool present = function.has_value();
  transfer(stream, present);
  if (!present)
    return;
  if constexpr (std::is_const_v<Optional>) {
    const double dead_time = function->dead_time();
    transfer_all(stream, function->numerator(), function->denominator(), dead_time);
  } else {
    Eigen::VectorXd numerator, denominator;
    double dead_time = 0.0;
    transfer_all(stream, numerator, denominator, dead_time);
    function.emplace(std::move(numerator), std::move(denominator), dead_time);
  }
}

/// Which form the signal has, and its members.
template <class Stream, class Signal>
void transfer_signal(Stream& stream, Signal& signal) {
  std::size_t form = signal.index();
  transfer(stream, form);
  if constexpr (!std::is_const_v<Signal>) {
    if (form >= std::variant_size_v<DisturbanceSignal>)
      throw std::runtime_error("message between processes: a signal that is none");
    constexpr auto empty = [](std::size_t number) -> DisturbanceSignal {
      switch (number) {
        case 0:
          return WhiteNoise{};
        case 1:
          return Sine{};
        case 2:
          return Ramp{};
        default:
          return StepSequence{};
      }
    };
    signal = empty(form);
  }
  if (auto* noise = std::get_if<WhiteNoise>(&signal))
    transfer_all(stream, noise->factor, noise->hold);
  if (auto* sine = std::get_if<Sine>(&signal))
    transfer_all(stream, sine->amplitude, sine->period);
  if (auto* ramp = std::get_if<Ramp>(&signal))
    transfer_all(stream, ramp->slope, ramp->start);
  if (auto* sequence = std::get_if<StepSequence>(&signal))
    transfer_list(stream, sequence->steps,
                  [&](auto& step) { transfer_all(stream, step.sample, step.level); });
}

/// Everything of a draw but its index.
template <class Stream, class Draw>
void transfer_draw(Stream& stream, Draw& draw) {
  transfer_all(stream, draw.kind, draw.named);
  transfer_list(stream, draw.mismatches, [&](auto& mismatch) {
    transfer_all(stream, mismatch.cv, mismatch.input, mismatch.parameter, mismatch.value);
    transfer_function(stream, mismatch.channel);
  });
  transfer_list(stream, draw.parameters,
                [&](auto& parameter) { transfer_all(stream, parameter.name, parameter.value); });
  transfer_list(stream, draw.disturbances, [&](auto& disturbance) {
    transfer_all(stream, disturbance.cv, disturbance.gain, disturbance.time_constant, disturbance.model);
    transfer_function(stream, disturbance.Gd);
    transfer_signal(stream, disturbance.signal);
    transfer_optional(stream, disturbance.inner_input, [&](auto& input) { transfer(stream, input); });
  });
  transfer_optional(stream, draw.affected_cvs,
                    [&](auto& cvs) { transfer_list(stream, cvs, [&](auto& cv) { transfer(stream, cv); }); });
  transfer_optional(stream, draw.tuning, [&](auto& tuning) {
    transfer_all(stream, tuning.parameter, tuning.index, tuning.factor);
  });
}

}  // namespace mpm
