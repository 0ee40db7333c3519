#include "scenarios/loop/excitation.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "scenarios/loop/signals.hpp"

namespace mpm {
namespace {

/// Draws new times for the steps of one variable, ascending and without duplicates.
std::vector<int> other_times(const std::vector<int>& listed, int samples, RandomStream& stream) {
  const int earliest = listed.front() / 2, latest = (listed.back() + samples) / 2;
  std::vector<int> times;
  for (std::size_t i = 0; i < listed.size(); ++i)
    times.push_back(earliest + static_cast<int>(stream.uniform() * (latest - earliest)));
  std::sort(times.begin(), times.end());
  for (std::size_t i = 1; i < times.size(); ++i)
    times[i] = std::max(times[i], times[i - 1] + 1);
  for (std::size_t i = times.size(); i-- > 0;)  // times that were pushed over the end go back
    times[i] = std::min(times[i], samples - static_cast<int>(times.size() - i));
  return times;
}

/// The steps with new times and in a new order, variable by variable; `level` draws the size of a step.
template <class Step, class Variable, class Level>
std::vector<Step> redrawn(const std::vector<Step>& steps, int samples, Variable variable, Level level,
                          RandomStream& stream) {
  std::map<Eigen::Index, std::vector<Step>> by_variable;
  for (const Step& step : steps)
    by_variable[step.*variable].push_back(step);
  std::vector<Step> all;
  for (auto& [name, own] : by_variable) {
    std::vector<int> listed;
    for (const Step& step : own)
      listed.push_back(step.sample);
    for (std::size_t i = own.size(); i > 1; --i)  // Fisher and Yates
      std::swap(own[i - 1], own[stream.below(i)]);
    const std::vector<int> times = other_times(listed, samples, stream);
    for (std::size_t i = 0; i < own.size(); ++i) {
      own[i].sample = times[i];
      level(own[i]);
      all.push_back(own[i]);
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const Step& a, const Step& b) { return a.sample < b.sample; });
  return all;
}

}  // namespace

std::vector<SignalStep> as_steps(const Eigen::MatrixXd& d) {
  std::vector<SignalStep> steps;
  for (Eigen::Index k = 0; k < d.cols(); ++k)
    for (Eigen::Index md = 0; md < d.rows(); ++md)
      if (d(md, k) != (k == 0 ? 0.0 : d(md, k - 1)))
        steps.push_back({md, static_cast<int>(k), d(md, k)});
  return steps;
}

Study with_excitation(const Study& study, std::int64_t index) {
  Study moved = study;
  SimulationOptions& simulation = moved.simulation;
  if (simulation.excitation == SignalSequence::shared)
    return moved;
  simulation.excitation = SignalSequence::shared;
  if (index == kBasisIndex)
    return moved;
  RandomStream stream = experiment_stream(study, index, StreamId::listed_steps);
  const auto share = [&stream] { return 0.5 + 0.5 * stream.uniform(); };
  simulation.steps = redrawn(
      simulation.steps, simulation.samples, &SignalStep::variable,
      [&](SignalStep& step) { step.level *= share(); }, stream);
  simulation.setpoint_steps = redrawn(
      simulation.setpoint_steps, simulation.samples, &SignalStep::variable,
      [&](SignalStep& step) {
        const double start = simulation.initial_setpoint(step.variable);
        step.level = start + share() * (step.level - start);
      },
      stream);
  simulation.limit_steps = redrawn(
      simulation.limit_steps, simulation.samples, &LimitStep::cv, [](LimitStep&) {}, stream);
  simulation.steps = as_steps(measured_disturbances(moved, index));
  simulation.random_steps = false;
  simulation.md_noise_standard_deviation = {};
  return moved;
}

}  // namespace mpm
