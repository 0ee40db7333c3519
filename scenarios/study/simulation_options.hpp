#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "scenarios/faults/other_fault.hpp"
#include "scenarios/faults/signal_sequence.hpp"
#include "scenarios/random/distribution.hpp"

namespace mpm {

/// One step of a signal, of a measured disturbance or a setpoint: from `sample` on it has the value `level`.
struct SignalStep {
  Eigen::Index variable;
  int sample;
  double level;

  bool operator==(const SignalStep&) const = default;
};

/// From `sample` on, a CV in a range has these soft limits.
struct LimitStep {
  Eigen::Index cv;
  int sample;
  double lower, upper;

  bool operator==(const LimitStep&) const = default;
};

/// A test signal that is added to the moves of one MV: +amplitude or -amplitude with the same probability,
/// anew every `hold` samples.
struct Dither {
  Eigen::Index mv;
  double amplitude;
  int hold;

  bool operator==(const Dither&) const = default;
};

/// A CV or an MV that operators have switched off for a while.
struct OffSpell {
  VariableSort sort;
  Eigen::Index variable;
  int sample, samples;
  std::optional<double> level = {};  ///< at which an MV is held; none: its value when the spell began

  /// First sample at which the controller has the variable again, if no other spell begins there.
  int end() const { return sample + samples; }
  bool operator==(const OffSpell&) const = default;
};

/// Density of the innovations of the measurement noise, scaled to variance 1.
enum class NoiseDistribution {
  normal,
  student,  ///< Student's t with 4 degrees of freedom: the fourth moment is infinite
  laplace,
};

/// Distribution, colour and size of the measurement noise.
struct NoiseOptions {
  NoiseDistribution distribution = NoiseDistribution::normal;
  double autocorrelation = 0.0;  ///< phi of e(k) = phi e(k-1) + sqrt(1 - phi^2) w(k): the variance stays
  /// Factor of the standard deviations of all CVs, drawn for each experiment. The basis case has 1: an
  /// experiment may have noise of another size than the benchmark.
  Distribution factor = Distribution::constant(1);
  /// Whether experiments share the innovations. The basis case has the shared sequence, too, but the basis
  /// case with other noise (kRepeatIndex) does not.
  SignalSequence sequence = SignalSequence::each;

  bool operator==(const NoiseOptions&) const = default;
};

/// Length, noise and excitation of every closed loop of the study.
struct SimulationOptions {
  int samples = 400;
  Eigen::VectorXd noise_standard_deviation;  ///< of the measurement noise, one a CV
  NoiseOptions noise = {};
  Eigen::VectorXd initial_setpoint;        ///< ny; of CVs with a setpoint
  std::vector<SignalStep> setpoint_steps;  ///< of CVs; the same in every experiment
  std::vector<LimitStep> limit_steps =
      {};                         ///< of soft limits, in the order of their samples; in every experiment
  std::vector<SignalStep> steps;  ///< of MDs, in the order of their samples; none with random_steps
  bool random_steps = false;      ///< steps of MDs drawn once for the study, the same in every experiment
  Distribution step_interval = Distribution::uniform(60, 100);  ///< samples between random steps
  Distribution step_level = Distribution::uniform(-0.4, 0.4);   ///< level after a random step
  /// Standard deviation of a variation of each MD that is added to its steps, drawn once for the study;
  /// empty: none.
  Eigen::VectorXd md_noise_standard_deviation = {};
  double md_noise_time_constant =
      0.0;                          ///< of its autocorrelation exp(-t/tau), time unit of the plant; 0: white
  std::vector<Dither> dither = {};  ///< of MVs; the same under every seed
  std::vector<OffSpell> off = {};   ///< in the order of their samples; the same in every experiment
  /// Whether all loops, including the benchmark, have the same steps and variations, or each loop has its own
  /// (with_excitation()).
  SignalSequence excitation = SignalSequence::shared;

  /// Does anything but noise and faults move the loop?
  bool is_excited() const {
    return random_steps || !steps.empty() || !setpoint_steps.empty() || !limit_steps.empty() ||
           md_noise_standard_deviation.size() > 0 || !dither.empty();
  }

  friend bool operator==(const SimulationOptions& a, const SimulationOptions& b);
};

}  // namespace mpm
