#include "plants/models/coker.hpp"

#include <array>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>

namespace mpm {
namespace {

constexpr int kCokerCvs = 12, kCokerMvs = 7, kCokerMds = 2;
constexpr int kDv1 = kCokerMvs + 1, kDv2 = kCokerMvs + 2;  // inputs after the MVs

/// gain e^{-dead_time s} / ((time_constant s + 1) (second s + 1)), times in minutes, numbers from 1.
struct CokerChannel {
  int cv, input;
  double gain, time_constant, dead_time, second = 0.0;
};

// clang-format off
constexpr std::array kChannels{
  // MV2: CV11 and the CVs that follow it
  CokerChannel{1, 2, 0.6, 30, 10}, CokerChannel{2, 2, 0.9, 25, 10}, CokerChannel{3, 2, -0.5, 40, 10, 10},
  CokerChannel{4, 2, 0.7, 35, 5}, CokerChannel{5, 2, 0.8, 20, 10}, CokerChannel{8, 2, -0.6, 45, 15},
  CokerChannel{10, 2, 0.9, 30, 5}, CokerChannel{11, 2, 1.0, 30, 10},
  // MV4: CV12 and the CVs that follow it
  CokerChannel{1, 4, -0.5, 40, 15}, CokerChannel{2, 4, 0.6, 30, 10}, CokerChannel{3, 4, 0.7, 30, 5},
  CokerChannel{4, 4, -0.6, 25, 10}, CokerChannel{6, 4, 0.9, 35, 10}, CokerChannel{12, 4, 1.0, 25, 5},
  // The other MVs, which are at limits in the steady state
  CokerChannel{1, 1, 0.4, 50, 15, 15}, CokerChannel{7, 1, 0.8, 40, 10}, CokerChannel{9, 1, 0.7, 45, 10},
  CokerChannel{3, 3, 0.5, 35, 10}, CokerChannel{7, 3, -0.6, 30, 10}, CokerChannel{9, 3, -0.5, 30, 5},
  CokerChannel{8, 5, 0.5, 40, 10}, CokerChannel{11, 5, 1.2, 20, 5},
  CokerChannel{2, 6, 0.3, 50, 20, 15}, CokerChannel{7, 6, 0.7, 35, 5}, CokerChannel{9, 6, 0.4, 60, 15},
  CokerChannel{1, 7, 1.6, 30, 10}, CokerChannel{5, 7, 0.8, 30, 5}, CokerChannel{12, 7, 1.2, 20, 5},
  // The exchange of drums (DV1) and the preparation of the next drum (DV2)
  CokerChannel{1, kDv1, 0.4, 25, 10}, CokerChannel{2, kDv1, 0.5, 30, 10}, CokerChannel{5, kDv1, -0.4, 25, 5},
  CokerChannel{7, kDv1, 0.6, 40, 10}, CokerChannel{8, kDv1, 0.6, 35, 10}, CokerChannel{9, kDv1, 0.5, 30, 10},
  CokerChannel{10, kDv1, -0.5, 30, 5}, CokerChannel{11, kDv1, 0.9, 25, 10},
  CokerChannel{1, kDv2, 0.3, 35, 10}, CokerChannel{3, kDv2, 0.5, 25, 5}, CokerChannel{4, kDv2, 0.5, 30, 10},
  CokerChannel{6, kDv2, -0.5, 30, 10}, CokerChannel{7, kDv2, 0.4, 30, 5}, CokerChannel{9, kDv2, 0.4, 35, 10},
  CokerChannel{12, kDv2, 0.9, 25, 10},
};
// clang-format on

TransferFunction transfer_of(const CokerChannel& channel) {
  const double a = channel.time_constant, b = channel.second;
  return b == 0.0 ? TransferFunction::first_order(channel.gain, a, channel.dead_time)
                  : TransferFunction(Eigen::VectorXd::Constant(1, channel.gain),
                                     Eigen::Vector3d(a * b, a + b, 1.0), channel.dead_time);
}

std::vector<PlantModel::Variable> numbered(const char* name, int count) {
  std::vector<PlantModel::Variable> variables;
  for (int i = 1; i <= count; ++i)
    variables.push_back({fmt::format("{}{}", name, i), "%", ""});
  return variables;
}

}  // namespace

PlantModel coker_12x7() {
  PlantModel plant{
      .name = "coker-12x7",
      .title = "Delayed coking fractionator, surrogate, 12 CVs, 7 MVs, 2 measured disturbances",
      .time_unit = "min",
      .cvs = numbered("CV", kCokerCvs),
      .mvs = numbered("MV", kCokerMvs),
      .mds = {{"DV1", "%", "Exchange of the coke drums"}, {"DV2", "%", "Preparation of the next coke drum"}},
      .G = TransferMatrix(kCokerCvs, kCokerMvs + kCokerMds)};
  for (const CokerChannel& channel : kChannels)
    plant.G(channel.cv - 1, channel.input - 1) = transfer_of(channel);
  return plant;
}

}  // namespace mpm
