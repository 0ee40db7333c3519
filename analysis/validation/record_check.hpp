#pragma once

#include <string>
#include <vector>

#include "scenarios/loop/plant_record.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// Returns what is implausible in a record of the plant of `study`, in one sentence each with what to do:
///
/// - a CV, MV or MD beyond its hard limits for more than 5 % of the samples: a unit, or another limit
/// - a CV that stays at one value for more than a tenth of the record: a frozen instrument
/// - an MV or MD that never moves, a model that explains nothing of any CV
/// - two columns that are exchanged, or an MV with the wrong sign: y_sim = G0 (u, d) explains far more of the
///   CVs if the columns are swapped or the sign is reversed. The explained share of a CV is
///   1 - var(y - y_sim) / var(y), not below -1, and far more is 0.8 more in the sum over the CVs
///
/// Throws InputError for records that make every verdict meaningless: an implausible value, a CV that never
/// changes, two variables with the same values, and absolute values where the study has deviations. A
/// variable looks absolute if its mean is outside its hard limits by more than their width or, without
/// limits, above 8 standard deviations. The message has the means, to be pasted as data.operating_point. A
/// variable that has an operating point there only gets a warning.
std::vector<std::string> check_record(const Study& study, const PlantRecord& record);

/// Returns the CVs whose setpoint the record lacks and that stay away from the setpoint of the study for most
/// of the time, by more than they move meanwhile: their setpoint was not that of the study.
std::vector<Eigen::Index> cvs_away_from_setpoints(const Study& study, const PlantRecord& record);

}  // namespace mpm
