#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "base/system/forked_service.hpp"

namespace mpm {

/// A simulation that somebody else wrote, from sample to sample, in the variables of its plant. Errors of all
/// members: ForeignFailure, after which the simulation has to be started again, and failures of the
/// surroundings (is_of_surroundings()), after which it cannot be used any more.
class ForeignSimulation {
 public:
  virtual ~ForeignSimulation() = default;

  /// Starts from the beginning with these parameters and inputs, one number for each that the model has.
  virtual void start(const Eigen::VectorXd& parameters, const Eigen::VectorXd& input) = 0;
  /// Gives the parameters other values from now on.
  virtual void change(const Eigen::VectorXd& parameters) = 0;
  /// Holds the input for one sample and returns the outputs at its end.
  virtual Eigen::VectorXd step(const Eigen::VectorXd& input) = 0;

 protected:
  ForeignSimulation() = default;
  ForeignSimulation(const ForeignSimulation&) = default;
  ForeignSimulation& operator=(const ForeignSimulation&) = default;
};

/// Settings for a simulation by somebody else.
struct ForeignOptions {
  double settle = 0.0;             ///< time for which inputs are held until the plant counts as at rest, > 0
  double settle_tolerance = 1e-6;  ///< largest move of an output at rest, as a share of max(1, |y|)
  double time_limit = 60.0;        ///< longest wait for an answer, in seconds of the clock

  bool operator==(const ForeignOptions&) const = default;
};

/// A nonlinear plant whose equations are not ours: an FMU or a program.
class ForeignModel {
 public:
  explicit ForeignModel(const ForeignOptions& options) : options_(options) {}
  virtual ~ForeignModel() = default;
  ForeignModel(const ForeignModel&) = delete;
  ForeignModel& operator=(const ForeignModel&) = delete;

  const ForeignOptions& options() const { return options_; }

  /// All settings of the study for this model, in one line. Two models are the same if their descriptions
  /// are.
  virtual std::string description() const = 0;
  /// Reads the files of the model, once, and checks them against the study. Errors: InputError.
  virtual void load() const = 0;
  /// The file of the model; empty if there is none.
  virtual std::filesystem::path file() const { return {}; }
  /// The program of the model, with its arguments; empty if there is none.
  virtual std::vector<std::string> command() const { return {}; }
  virtual Eigen::Index output_count() const = 0;
  /// May this parameter of a loaded model change while it runs?
  virtual bool is_tunable(std::size_t parameter) const = 0;
  /// A simulation of a loaded model, not yet started.
  virtual std::unique_ptr<ForeignSimulation> simulation(double sample_time) const = 0;

 private:
  ForeignOptions options_;
};

}  // namespace mpm
