#pragma once

#include <string>
#include <vector>

#include "plants/linear/transfer_matrix.hpp"

namespace mpm {

/// A benchmark plant: its nominal model with the names and units of its variables.
///
/// | symbol | meaning                                              | shape                            |
/// |--------|------------------------------------------------------|----------------------------------|
/// | G      | rows: CVs; columns: MVs, then MDs; times in time_unit | cvs x (mvs + mds)                |
struct PlantModel {
  /// A controlled, manipulated or measured disturbance variable.
  struct Variable {
    std::string name;
    std::string unit;
    std::string description;

    bool operator==(const Variable&) const = default;
  };

  std::string name;   ///< the name in the catalogue
  std::string title;  ///< one line for people
  std::string time_unit;
  std::vector<Variable> cvs;
  std::vector<Variable> mvs;
  std::vector<Variable> mds;
  TransferMatrix G;

  /// A channel that has the coefficients of its step response; its parameters were fitted to them.
  struct StepFit {
    Eigen::Index cv, input;
    double error;  ///< largest error of the fit, as a share of the largest coefficient

    bool operator==(const StepFit&) const = default;
  };
  std::vector<StepFit> step_fits = {};

  /// Errors: InputError if the plant, its time unit or a variable has an empty name, two variables have the
  /// same name, there is no CV or no MV, or G is not cvs x (mvs + mds).
  void validate() const;

  bool operator==(const PlantModel&) const = default;
};

/// The names of variables, in their order.
std::vector<std::string> variable_names(const std::vector<PlantModel::Variable>& variables);

/// The names of the MVs and then the MDs.
std::vector<std::string> input_names(const PlantModel& plant);

}  // namespace mpm
