#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/loop/plant_record.hpp"
#include "scenarios/study/study.hpp"

// A record of the plant as a study: the same controller under what moved the plant while it was recorded.

namespace mpm {

/// The study whose loops are as long as the record, under its measured disturbances, and with the setpoints
/// and soft limits as they were at the time (those of the study where they were not recorded). What operators
/// had taken is off, MVs where they were recorded. Its basis case
/// is the nominal loop of the record, and its experiments are loops of this very controller, excitation and
/// length. Samples are missing in them as often as in the record, in gaps of the same mean length, filled as
/// the [data] says, and they have as many candidates, up to 9, one of which drives every second disturbance;
/// what else a historian does to them stands in the [record] of the study. It is the text of `study` with
/// other values, as parse_study() reads it: what is not known of a plant (a test signal, named scenarios,
/// thresholds, reported numbers) is left out, and so is the self-check, since nobody can choose another
/// excitation.
///
/// Moves of MDs are steps of the text: with more than 10000 of them moves below a growing part of the
/// standard deviation are left out of the simulated loops.
///
/// Errors: InputError as parse_study(), for limits outside of the hard ones, and for a record that is too
/// short for the windows of the study.
Study recorded_study(const Study& study, const PlantRecord& record, const std::vector<std::string>& methods,
                     const std::optional<MonitoringOptions>& monitoring);

/// The study with CVs that an analyser measures with this period, samples of the controller, each. Errors: as
/// parse_study().
Study with_analysers(const Study& study, const std::map<std::string, int>& periods);

/// The loops of a calibration run.
struct TrialPlan {
  int healthy = 0, faulty = 0;
  /// Standard deviation of the errors of the model: of gain, time constants and dead time of every channel,
  /// drawn anew for each loop, beside disturbances that never stop, of up to three quarters of the noise of a
  /// CV. 0: the model is exact.
  double model_error = 0.0;
  std::string judged = {};  ///< how these loops are judged, for people and to know them again
};

/// The study of a calibration run: loops of recorded_study() without a fault, and others with the faults of
/// the study, its kinds as often as there, under the seed of the study with the bits of kCalibrationBits
/// flipped, in the worlds of `plan`. No sample is missing in them. Its text is the same whatever the methods
/// are. Errors: as parse_study().
Study trial_study(const Study& recorded, const TrialPlan& plan);

/// Is this the study of a calibration run? Its title says so.
bool is_trial_study(const Study& study);

}  // namespace mpm
