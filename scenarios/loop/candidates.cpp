#include "scenarios/loop/candidates.hpp"

#include <cstdint>
#include <variant>

#include "scenarios/faults/fault.hpp"
#include "scenarios/loop/signals.hpp"
#include "scenarios/random/random_stream.hpp"

namespace mpm {
namespace {

/// The form of a decoy for the signal `cause`.
DisturbanceSignal decoy_form(const DisturbanceSignal& cause) {
  if (std::holds_alternative<RandomWalk>(cause) || std::holds_alternative<Bursts>(cause))
    return cause;
  if (const WhiteNoise* const noise = std::get_if<WhiteNoise>(&cause))
    return *noise;
  return WhiteNoise{};
}

StreamId decoy_stream(Eigen::Index candidate) {
  return static_cast<StreamId>(static_cast<std::uint32_t>(StreamId::candidate_signals) +
                               static_cast<std::uint32_t>(candidate));
}

}  // namespace

Eigen::Index true_candidate(const Study& study, const ExperimentDraw& draw) {
  if (study.record.candidates == 0 || draw.disturbances.empty())
    return -1;
  RandomStream stream = experiment_stream(study, draw.index, StreamId::candidate);
  const bool logged = stream.uniform() < study.record.candidate_share;
  const std::uint64_t place = stream.below(static_cast<std::uint64_t>(study.record.candidates));
  return logged ? static_cast<Eigen::Index>(place) : -1;
}

Eigen::MatrixXd logged_candidates(const Study& study, const ExperimentDraw& draw) {
  if (study.record.candidates == 0)
    return {};
  const Eigen::Index cause = true_candidate(study, draw);
  const DisturbanceSignal form =
      draw.disturbances.empty() ? DisturbanceSignal{WhiteNoise{}} : draw.disturbances.front().signal;
  Eigen::MatrixXd candidates(study.record.candidates, study.simulation.samples);
  for (Eigen::Index row = 0; row < candidates.rows(); ++row)
    candidates.row(row) = disturbance_signal(
        row == cause ? form : decoy_form(form), study.disturbance.v_standard_deviation,
        study.controller.sample_time, study.simulation.samples,
        experiment_stream(study, draw.index,
                          row == cause ? StreamId::disturbance_signal : decoy_stream(row)));
  return candidates;
}

}  // namespace mpm
