#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/records/record_verdict.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// What each CV costs its controller against the loop as designed, over the samples of `y` from `from` on
/// that are there and at which the controller has the CV:
///
///   ratio = (now + f)/(designed + f),   now = cv_costs(y),
///
/// with f = 0 for a CV with a setpoint and f = v for a CV in a range (cost_floor()). A level with both counts
/// as in its range (LevelCost::in_range). The cost as designed is
///
///   designed = mean (y0 - y_set)^2 + v   of a CV with a setpoint,
///   designed = mean E dist(y0 + n)^2     of one in a range,
///
/// with y0 the nominal loop, n ~ N(0, v) the noise of the record, and dist the distance outside of the soft
/// limits at that time. The ratio is NaN for a CV with neither, and for one without samples.
///
/// | symbol | name  | shape  | unit                                       |
/// |--------|-------|--------|--------------------------------------------|
/// | y, y0  | y, y0 | ny x N | CV, deviations from the operating point    |
/// | v      | noise | ny     | CV^2                                       |
std::vector<CvCost> cost_of_record(const Study& study, const Eigen::Ref<const Eigen::MatrixXd>& y,
                                   const Eigen::Ref<const Eigen::MatrixXd>& y0,
                                   const Eigen::Ref<const Eigen::VectorXd>& noise, Eigen::Index from);

}  // namespace mpm
