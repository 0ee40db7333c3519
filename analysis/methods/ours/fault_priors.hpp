#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessment.hpp"
#include "scenarios/random/distribution.hpp"
#include "scenarios/study/study.hpp"

// What may be wrong in a loop, and how probable it is before the record is seen.

namespace mpm {

/// What the method `likelihood` takes to be possible before it sees a record
/// (analysis/methods/ours/fault_priors).
enum class FaultPriors : std::int8_t {
  wide = 0,   ///< whatever a plant may have: one fault or several, of any size
  study = 1,  ///< the faults that the study draws, as often and as large as it draws them
};

/// The density of a distribution at x. A constant c counts as uniform within 0.1 % of it (within 0.001 for
/// c = 0), a normal distribution as cut off at four standard deviations.
double density(const Distribution& distribution, double x);

/// The ends of the interval outside of which density() is zero.
std::pair<double, double> support(const Distribution& distribution);

/// A parameter of a channel that may be wrong.
struct SizePrior {
  Channel channel;
  MismatchParameter parameter;
  double weight;      ///< P(this channel and parameter | one mismatch of its CV)
  Distribution size;  ///< of Mismatch::value
};

/// A first-order disturbance model y_d(k+1) = a y_d(k) + b w(k) with a time constant out of a few.
struct DisturbancePrior {
  double a;
  double weight;  ///< of this time constant; they sum to 1
  double scale;   ///< b = scale times a number with the density `size`
  Distribution size;
};

/// What may be wrong with one CV.
struct CvPrior {
  double mpm, ud, both;               ///< weights against 1 for nothing
  std::vector<SizePrior> mismatches;  ///< their weights sum to 1, if there is one
  std::vector<DisturbancePrior> disturbances;
  double sensor = 0.0;  ///< weight of a fault of its sensor, against 1 for nothing; with wide priors
};

/// | `priors` | faults                                 | sizes                       | noise           |
/// |----------|----------------------------------------|-----------------------------|-----------------|
/// | wide     | each CV by itself, `fault_probability` | what a plant may have       | the benchmark's |
/// | study    | as the study draws them                | as the study draws them     | the study's     |
///
/// `fault_probability` is the probability that some CV has a fault. The noise of the benchmark is known
/// within a factor of about two.
struct FaultPriorSet {
  std::vector<CvPrior> cvs;  ///< ny
  /// Weights against 1 for nothing, with wide priors. `input` is that of a disturbance on each MV, and of a
  /// sticking valve of each MV; `md` is that of a wrong measurement of each MD.
  double input = 0.0, md = 0.0;
  /// Whether only one CV has a fault. Otherwise each CV may have one, independently of the others.
  bool one_fault = false;
  /// nu of the scaled inverse chi-square distribution of the variance of the noise about the known one;
  /// infinity: it is known.
  double noise_freedom;
  /// Whether x(0) = 0, as in every loop of a study. Otherwise the disturbance is stationary.
  bool starts_from_rest;
};

/// The set of priors that `priors` names. `noise` (ny) are the standard deviations of the measurement noise,
/// in which the sizes of wide disturbances are measured. `imperfect`: healthy models have errors and healthy
/// loops a background, so that wide disturbances begin above kLargestBackground, and wide factors reach
/// beyond what a corrected model may be off.
FaultPriorSet fault_priors(const Study& study, FaultPriors priors, double fault_probability,
                           const Eigen::Ref<const Eigen::VectorXd>& noise, bool imperfect = false);

}  // namespace mpm
