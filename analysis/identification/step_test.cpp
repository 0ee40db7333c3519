#include "analysis/identification/step_test.hpp"

#include <cstdint>
#include <memory>

#include <fmt/format.h>

#include "base/error.hpp"
#include "plants/linear/linear_plant.hpp"
#include "plants/nonlinear/nonlinear_plant.hpp"
#include "scenarios/loop/signals.hpp"

namespace mpm {
namespace {

constexpr std::uint64_t kOtherSeed = 0x9e3779b97f4a7c15;  // noise that no experiment of the study has

std::unique_ptr<Plant> faultless_plant(const Study& study) {
  const double Ts = study.controller.sample_time;
  if (study.nonlinear)
    return nonlinear_plant(study.nonlinear->model, Ts, study.nonlinear->integration, {});
  return std::make_unique<LinearPlant>(study.plant.G, Ts);
}

/// y after a step of this input, from rest.
Eigen::MatrixXd stepped(Plant& plant, Eigen::Index input, double size, int samples) {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(plant.input_count());
  plant.reset(u);
  u(input) = size;
  Eigen::MatrixXd y(plant.output_count(), samples);
  for (int k = 0; k < samples; ++k) {
    if (plant.advance(u) != PlantStatus::ok)
      throw InputError(fmt::format("step test: input {} by {}", input, size), plant.failure(),
                       "steps that the plant can follow");
    y.col(k) = plant.output();
  }
  return y;
}

}  // namespace

std::vector<StepResponse> step_test(const Study& study, const StepTestOptions& options) {
  const Eigen::Index inputs = study.mv_count() + study.md_count();
  if (options.sizes.size() != inputs || !(options.sizes.array() > 0.0).all())
    throw InputError("sizes of the steps", fmt::format("{} numbers", options.sizes.size()),
                     fmt::format("{} numbers > 0", inputs));
  if (options.samples < 1)
    throw InputError("samples of a step response", fmt::to_string(options.samples), ">= 1");
  Study noisy = study;
  noisy.seed ^= kOtherSeed;
  noisy.simulation.noise.sequence = SignalSequence::each;  // new noise for each direction of a step
  noisy.simulation.samples = options.samples;
  const std::unique_ptr<Plant> plant = faultless_plant(study);
  std::vector<StepResponse> responses;
  for (Eigen::Index input = 0; input < inputs; ++input) {
    const double size = options.sizes(input);
    Eigen::MatrixXd up = stepped(*plant, input, size, options.samples);
    Eigen::MatrixXd down = stepped(*plant, input, -size, options.samples);
    if (options.noise) {
      up += measurement_noise(noisy, 2 * input);
      down += measurement_noise(noisy, 2 * input + 1);
    }
    const Eigen::MatrixXd difference = up - down;
    responses.push_back({difference / (2.0 * size), (up + down).rowwise().norm().cwiseQuotient(
                                                        difference.rowwise().norm().cwiseMax(1e-300))});
  }
  return responses;
}

}  // namespace mpm
