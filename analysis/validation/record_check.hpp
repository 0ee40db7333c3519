#pragma once

#include <string>
#include <vector>

#include "scenarios/loop/plant_record.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// What is implausible in a record of the plant of `study`, a sentence each with what to do:
///
/// - a CV, MV or MD beyond its hard limits for more than 5 % of the samples: a unit, or another limit
/// - a CV that stays at one value for more than a tenth of the record: a frozen instrument
/// - an MV or MD that never moves, a model that explains nothing of any CV
/// - two columns that are exchanged, or an MV with the wrong sign: y_sim = G0 (u, d) explains far more of the
///   CVs when they are turned round. Explained is 1 - var(y - y_sim) / var(y), not below -1, and far more is
///   0.8 in the sum over the CVs
///
/// Errors: InputError for records that make every verdict meaningless: an implausible value, a CV that
/// never changes, two variables with the same values, and absolute values where the study has deviations: a
/// mean beyond the range of the hard limits by more than its width, or, without limits, above 8 standard
/// deviations. Its text has the means, to be pasted as data.operating_point; a variable that has one there is
/// warned of only.
std::vector<std::string> check_record(const Study& study, const PlantRecord& record);

/// The CVs with a setpoint that stay away from it for most of the time, by more than they move meanwhile,
/// where the record has no setpoint: that of the study is not the one that was there.
std::vector<Eigen::Index> cvs_away_from_setpoints(const Study& study, const PlantRecord& record);

}  // namespace mpm
