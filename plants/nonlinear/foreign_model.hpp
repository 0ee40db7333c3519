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
/// members: ForeignFailure, after which it has to be started again, and those of the surroundings
/// (is_of_surroundings()), after which it is of no use.
class ForeignSimulation {
 public:
  virtual ~ForeignSimulation() = default;

  /// Starts again from the beginning with these parameters and inputs, one number for each of the model.
  virtual void start(const Eigen::VectorXd& parameters, const Eigen::VectorXd& input) = 0;
  /// Gives the parameters other values from now on.
  virtual void change(const Eigen::VectorXd& parameters) = 0;
  /// Holds the input for one sample; the outputs at its end.
  virtual Eigen::VectorXd step(const Eigen::VectorXd& input) = 0;

 protected:
  ForeignSimulation() = default;
  ForeignSimulation(const ForeignSimulation&) = default;
  ForeignSimulation& operator=(const ForeignSimulation&) = default;
};

/// Settings for a simulation by somebody else.
struct ForeignOptions {
  double settle = 0.0;             ///< time for which inputs are held until the plant counts as at rest, > 0
  double settle_tolerance = 1e-6;  ///< largest move of an output at rest, of max(1, |y|)
  double time_limit = 60.0;        ///< seconds of the clock that an answer may take

  bool operator==(const ForeignOptions&) const = default;
};

/// The source of the equations of a nonlinear plant that are not ours.
class ForeignModel {
 public:
  explicit ForeignModel(const ForeignOptions& options) : options_(options) {}
  virtual ~ForeignModel() = default;
  ForeignModel(const ForeignModel&) = delete;
  ForeignModel& operator=(const ForeignModel&) = delete;

  const ForeignOptions& options() const { return options_; }

  /// Every choice of the study about it, in one line: two models are the same when these are.
  virtual std::string description() const = 0;
  /// Reads its files, once, and checks them against the study. Errors: InputError.
  virtual void load() const = 0;
  /// The file that it is; none: empty.
  virtual std::filesystem::path file() const { return {}; }
  /// The program that it is, with its arguments; none: empty.
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
