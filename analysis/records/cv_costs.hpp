#pragma once

#include <vector>

#include <Eigen/Core>

#include "analysis/records/record_verdict.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// What each CV costs its controller against the loop as designed, over the samples k of `y` from `from` on
/// that are there and at which the controller has the CV:
///
///   setpoint   now = mean (y - y_set)^2,      designed = mean (y0 - y_set)^2 + v,      ratio = now /
///   designed range      now = mean dist(y)^2,          designed = mean E dist(y0 + n)^2,        ratio = (now
///   + v) / (designed + v)
///
/// with y0 the nominal loop, n ~ N(0, v) the noise, and dist the distance outside of the soft limits of the
/// time. NaN of a CV with neither, and without samples.
///
/// | symbol | name  | shape  | unit                                       |
/// |--------|-------|--------|--------------------------------------------|
/// | y, y0  | y, y0 | ny x N | CV, deviations from the operating point    |
/// | v      | noise | ny     | CV^2                                       |
std::vector<CvCost> cv_costs(const Study& study, const Eigen::Ref<const Eigen::MatrixXd>& y,
                             const Eigen::Ref<const Eigen::MatrixXd>& y0,
                             const Eigen::Ref<const Eigen::VectorXd>& noise, Eigen::Index from);

}  // namespace mpm
