#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/sensitivity/nominal_sensitivity.hpp"
#include "base/non_finite.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// Returns T0 at one frequency, from its step responses s_1 ... s_L (s_0 = 0):
///
///   T0(e^{jw Ts})(:, j) = sum_{l=1}^{L} (s_l - s_{l-1}) e^{-jw Ts l}
///
/// This is exact for responses that have settled, up to the Nyquist frequency pi/Ts; beyond that it repeats.
///
/// | symbol | name          | meaning                                      | shape     | unit              |
/// |--------|---------------|----------------------------------------------|-----------|-------------------|
/// | T0     | result        | from the active CVs to the active CVs        | m x m     | CV/CV             |
/// | w      | `frequency`   |                                              | 1         | rad per time unit |
/// | Ts     | `sample_time` |                                              | 1         | time unit         |
///
/// A CV inside its range has no column in T0 because it has no effect, and it has no row here.
/// @throws InputError unless frequency >= 0 and sample_time > 0
Eigen::MatrixXcd active_frequency_response(const NominalSensitivity& sensitivity, double frequency,
                                           double sample_time);

/// The interaction of the loops of a study and the frequencies at which its controller works (section 4.3.1,
/// figures 4.5, 4.6, 4.11, 4.12).
///
/// | symbol   | member            | shape | unit                                                        |
/// |----------|-------------------|-------|-------------------------------------------------------------|
/// |          | cvs               | m     | CVs at a setpoint or an active limit: those of T0           |
/// |          | mvs               | m     | MVs that the controller can move; empty if not exactly m    |
/// | w        | frequency         | F     | rad per time unit of the plant, up to the Nyquist frequency |
/// | RPN      | rpn               | F     | weight function (4.16) at w                                 |
/// | |Lambda| | relative_gain     | F     | m x m: magnitudes of the dynamic RGA of G0 at w, see mvs    |
/// |          | peaks             |       | local maxima of the RPN, by frequency                       |
/// |          | rpn_frequency     | 1     | w of the largest RPN; NaN without active CVs                |
/// |          | rpn_maximum       | 1     | RPN there                                                   |
/// |          | relative_gain_at_maximum | m x m | |Lambda| there                                       |
///
/// In a direction in which the controller needs only one sample, T0 = e^{-jw Ts}, and |S0 T0| rises to 2 at
/// the Nyquist frequency for any plant. The largest RPN then lies at this frequency, and a peak at a lower
/// frequency belongs to a slower direction. The Nyquist frequency counts as a peak if the RPN rises towards
/// it.
///
/// `mvs` and the relative gains are empty if the numbers of active CVs and MVs differ, so that they select no
/// square part of G0, or if this part has no inverse, for example because no MV moves a CV. The diagonal
/// pairs CVs and MVs in the order of their lists.
struct LoopInteraction {
  struct Peak {
    double frequency;
    double rpn;
  };

  std::vector<Eigen::Index> cvs;
  std::vector<Eigen::Index> mvs;
  Eigen::VectorXd frequency;
  Eigen::VectorXd rpn;
  std::vector<Eigen::MatrixXd> relative_gain;
  std::vector<Peak> peaks;
  double rpn_frequency = kNaN;
  double rpn_maximum = kNaN;
  Eigen::MatrixXd relative_gain_at_maximum;
};

/// Computes the interaction at `count` frequencies with even logarithmic spacing. They go from a tenth of the
/// lowest frequency that the length of the step responses resolves, 2 pi/(L Ts), to the Nyquist frequency.
/// The maximum of the RPN is refined between them.
///
/// G0 has its exact frequency response with its exact dead times, not that of the sampled model of the
/// controller. A T0 with numbers that are not finite, or above 1e100, has no RPN: all members except `cvs`
/// are empty.
/// @throws InputError for fewer than 2 frequencies
LoopInteraction loop_interaction(const Study& study, const OperatingPoint& point,
                                 const NominalSensitivity& sensitivity, Eigen::Index count = 200);

}  // namespace mpm
