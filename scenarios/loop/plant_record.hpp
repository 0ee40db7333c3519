#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace mpm {

/// The record of a plant, read from a file as the [data] of a study says: at the samples of the controller,
/// in the study's units, as deviations from the operating point. CVs and MDs of analysers are as these have
/// shown them.
///
/// | symbol   | member       | shape  | meaning                                                         |
/// |----------|--------------|--------|-----------------------------------------------------------------|
/// | y        | y            | ny x N | CVs; NaN where missing, of bad quality, or without the controller |
/// | u, d     | u, d         | nu x N, nd x N | MVs and MDs, gaps held; no NaN                          |
/// | u_target | u_target     | nu x N | targets of MVs; NaN in the row of an MV without a column        |
/// | y_set    | y_set        | ny x N | setpoints; NaN in the row of a CV without a column              |
/// |          | lower, upper | ny x N | soft limits; NaN in the row of a CV without a column            |
/// | y_sim    | y_sim        | ny x N | output of the model; NaN in the row of a CV without a column    |
/// |          | u_off        | nu x N | 1 where operators have the MV, 0 elsewhere; empty: nowhere      |
/// |          | y_off        | ny x N | the same for the CVs                                            |
/// |          | candidates   | nc x N | signals that the model does not know, without their means       |
struct PlantRecord {
  Eigen::MatrixXd y, u, d, u_target, y_set, lower, upper, y_sim, candidates;
  Eigen::MatrixXd u_off = {}, y_off = {};
  std::vector<std::string> candidate_names;  ///< names of their columns
  std::vector<std::string> stamps;           ///< of the samples, for people
  /// First sample of the benchmark period and the one after its last; equal: there is none.
  std::pair<Eigen::Index, Eigen::Index> benchmark{0, 0};
  std::vector<std::string> warnings;  ///< a sentence each

  Eigen::Index samples() const { return y.cols(); }
  /// Was this variable in the hands of operators at sample k?
  bool has_mv_off(Eigen::Index mv, Eigen::Index k) const { return u_off.size() > 0 && u_off(mv, k) == 1.0; }
  bool has_cv_off(Eigen::Index cv, Eigen::Index k) const { return y_off.size() > 0 && y_off(cv, k) == 1.0; }
};

}  // namespace mpm
