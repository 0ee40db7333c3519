#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/loop/plant_record.hpp"
#include "scenarios/study/study.hpp"

// A record of the plant as a study: the same controller under the inputs that moved the plant during the
// record.

namespace mpm {

/// Returns a study whose loops are as long as the record and run under its measured disturbances, with the
/// setpoints and soft limits of the time (those of `study` if they were not recorded). Variables that
/// operators had taken off control are off; such MVs stay at their recorded values. The basis case is the
/// nominal loop of the record, and the experiments are loops with the same controller, excitation and length.
/// In these, samples are missing as often as in the record, in gaps of the same mean length, filled as [data]
/// says. They have as many candidates as the record, up to 9, one of which drives every second disturbance.
/// The [record] of the study says what else a historian does to them.
///
/// The result is the text of `study` with other values, as parse_study() reads it. Everything that is not
/// known of a plant is left out (a test signal, named scenarios, thresholds, reported numbers). So is the
/// self-check, since nobody can choose another excitation.
///
/// Moves of MDs become steps in the text. If there are more than 10000 of them, small moves are left out of
/// the simulated loops: those below a fraction of the standard deviation, which grows until the rest are few
/// enough.
///
/// Errors: InputError as parse_study(), for limits outside the hard limits, and for a record that is too
/// short for the windows of the study.
Study recorded_study(const Study& study, const PlantRecord& record, const std::vector<std::string>& methods,
                     const std::optional<MonitoringOptions>& monitoring);

/// Returns the study with the CVs in `periods` measured by analysers, each with its period in samples of the
/// controller. Errors: as parse_study().
Study with_analysers(const Study& study, const std::map<std::string, int>& periods);

/// The loops of a calibration run.
struct TrialPlan {
  int healthy = 0, faulty = 0;
  /// Standard deviation of the relative errors of the model, in gain, time constants and dead time of every
  /// channel, drawn anew for each loop. Above 0, the loops also have disturbances that never stop, of up to
  /// three quarters of the noise of a CV. 0: the model is exact.
  double model_error = 0.0;
  std::string judged = {};  ///< how these loops are judged, for people and to recognise them
};

/// Returns the study of a calibration run, made from recorded_study(): loops without a fault, and loops with
/// the faults of the study, each kind in the same proportion as there. Its seed is that of the study with the
/// bits of kCalibrationBits flipped, and its worlds are those of `plan`. No sample is missing in the loops.
/// The text does not depend on the methods. Errors: as parse_study().
Study trial_study(const Study& recorded, const TrialPlan& plan);

/// Returns whether this is the study of a calibration run, which its title says.
bool is_trial_study(const Study& study);

}  // namespace mpm
