#pragma once

#include <Eigen/Core>

#include "analysis/methods/disturbance_scan.hpp"

namespace mpm {

/// The noise that simulation errors `e` (N, NaN where there is no sample) of a healthy loop show: white, an
/// AR(1), or an AR(1) state under white noise, whichever has the largest log L - p log(N) / 2 with its p
/// parameters. The last one is what the errors look like where a plant is not quite its model. Its deviation
/// is `least` or more. Throws InputError for fewer than 10 samples.
BaseNoise fitted_base_noise(const Eigen::Ref<const Eigen::RowVectorXd>& e, double least);

/// The record without outliers: samples that are off the median of two neighbours on each side by more than
/// six standard deviations of that distance over the record (from its median), and by more than twice the
/// range of these neighbours, so that a signal which rises steeply for a while keeps its samples. NaN there,
/// as where there is no sample.
Eigen::RowVectorXd without_outliers(const Eigen::Ref<const Eigen::RowVectorXd>& e);

}  // namespace mpm
