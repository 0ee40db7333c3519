#pragma once

#include <string>

#include <Eigen/Core>

namespace mpm {

/// The outcome of a step of a plant.
enum class PlantStatus {
  ok,
  failed,  ///< the equations could not be integrated; the plant has to be reset before it goes on
};

/// A plant between samples, as a closed loop sees it: a controller reads output(), computes u(k) and calls
/// advance(u(k)), which holds it until the next sample.
///
/// | symbol | member              | shape         | unit            |
/// |--------|---------------------|---------------|-----------------|
/// | y(k)   | output()            | output_count()| of the plant    |
/// | u(k)   | argument of advance | input_count() | of the plant    |
/// | Ts     | sample_time()       |               | of the plant    |
class Plant {
 public:
  virtual ~Plant() = default;

  virtual Eigen::Index output_count() const = 0;
  virtual Eigen::Index input_count() const = 0;
  virtual double sample_time() const = 0;

  /// Puts the plant at its steady state under the constant `steady_input` (input_count()), as if it had acted
  /// for ever. Errors: InputError for a wrong size or a number that is not finite; NoSteadyState.
  virtual void reset(const Eigen::Ref<const Eigen::VectorXd>& steady_input) = 0;

  /// y(k), output_count(): just before the input of sample k is applied.
  virtual const Eigen::VectorXd& output() const = 0;

  /// Holds u(k) = `input` (input_count()) over [k Ts, (k+1) Ts) and goes on to sample k + 1. Errors:
  /// InputError for a wrong size.
  virtual PlantStatus advance(const Eigen::Ref<const Eigen::VectorXd>& input) = 0;

  /// Tells people why advance() failed.
  virtual std::string failure() const { return "the plant could not be integrated"; }

 protected:
  Plant() = default;
  Plant(const Plant&) = default;
  Plant& operator=(const Plant&) = default;
};

}  // namespace mpm
