#include "plants/models/transfer_function_plants.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

namespace mpm {
namespace {

/// gain e^{-dead_time s} / (time_constant s + 1), times in minutes.
struct FirstOrderEntry {
  double gain;
  double dead_time;
  double time_constant;
};

// clang-format off
/// The Shell fractionator, eq. 6.18.
constexpr std::array<std::array<FirstOrderEntry, 5>, 7> kModel{{
  //      u1              u2              u3              d1              d2
  {{{4.05, 27, 50}, {1.77, 28, 60}, {5.88, 27, 50}, {1.20, 27, 45}, {1.44, 27, 40}}},  // y1
  {{{5.39, 18, 50}, {5.72, 14, 60}, {6.90, 15, 40}, {1.52, 15, 25}, {1.83, 15, 20}}},  // y2
  {{{3.66,  2,  9}, {1.65, 20, 30}, {5.53,  2, 40}, {1.16,  0, 11}, {1.27,  0,  6}}},  // y3
  {{{5.92, 11, 12}, {2.54, 12, 27}, {8.10,  2, 20}, {1.73,  0,  5}, {1.79,  0, 19}}},  // y4
  {{{4.13,  5,  8}, {2.38,  7, 19}, {6.23,  2, 10}, {1.31,  0,  2}, {1.26,  0, 22}}},  // y5
  {{{4.06,  8, 13}, {4.18,  4, 33}, {6.53,  1,  9}, {1.19,  0, 19}, {1.17,  0, 24}}},  // y6
  {{{4.38, 20, 33}, {4.42, 22, 44}, {7.20,  0, 19}, {1.14,  0, 27}, {1.26,  0, 32}}},  // y7
}};
// clang-format on

// clang-format off
/// Eq. 2.25 and 4.18: outputs y1, y2 and y7 of eq. 6.18, except for the dead time of y3-u3, 19 min here.
constexpr std::array<std::array<FirstOrderEntry, 3>, 3> kReducedModel{{
  //      u1              u2              u3
  {{{4.05, 27, 50}, {1.77, 28, 60}, {5.88, 27, 50}}},  // y1
  {{{5.39, 18, 50}, {5.72, 14, 60}, {6.90, 15, 40}}},  // y2
  {{{4.38, 20, 33}, {4.42, 22, 44}, {7.20, 19, 19}}},  // y3
}};
// clang-format on

template <std::size_t Rows, std::size_t Cols>
TransferMatrix make_transfer_matrix(const std::array<std::array<FirstOrderEntry, Cols>, Rows>& model) {
  TransferMatrix G(Rows, Cols);
  for (std::size_t row = 0; row < Rows; ++row) {
    for (std::size_t col = 0; col < Cols; ++col) {
      const FirstOrderEntry& entry = model[row][col];
      G(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(col)) =
          TransferFunction::first_order(entry.gain, entry.time_constant, entry.dead_time);
    }
  }
  return G;
}

}  // namespace

PlantModel shell_fractionator_7x3() {
  return {.name = "shell-7x3",
          .title = "Shell heavy oil fractionator, 7 CVs, 3 MVs, 2 measured disturbances",
          .time_unit = "min",
          .cvs = {{"y1", "1", "Top End Point"},
                  {"y2", "1", "Side End Point"},
                  {"y3", "1", "Top Temperature"},
                  {"y4", "1", "Upper Reflux Temperature"},
                  {"y5", "1", "Side Draw Temperature"},
                  {"y6", "1", "Intermediate Reflux Temperature"},
                  {"y7", "1", "Bottoms Reflux Temperature"}},
          .mvs = {{"u1", "1", "Top Draw"}, {"u2", "1", "Side Draw"}, {"u3", "1", "Bottoms Reflux Duty"}},
          .mds = {{"d1", "1", "Intermediate Reflux Duty"}, {"d2", "1", "Upper Reflux Duty"}},
          .G = make_transfer_matrix(kModel)};
}

PlantModel shell_fractionator_3x3() {
  return {.name = "shell-3x3",
          .title = "Shell heavy oil fractionator, 3 CVs, 3 MVs",
          .time_unit = "min",
          .cvs = {{"y1", "1", "Top Composition"},
                  {"y2", "1", "Side Composition"},
                  {"y3", "1", "Bottoms Reflux Temperature"}},
          .mvs = {{"u1", "1", "Top Draw"}, {"u2", "1", "Side Draw"}, {"u3", "1", "Bottoms Reflux Duty"}},
          .mds = {},
          .G = make_transfer_matrix(kReducedModel)};
}

PlantModel distillation_column() {
  const auto lag = [](double gain) { return TransferFunction::first_order(gain, 75); };
  return {.name = "distillation-column",
          .title = "High-purity distillation column, LV configuration, 2 CVs, 2 MVs",
          .time_unit = "min",
          .cvs = {{"yD", "1", "Composition of the top product"},
                  {"xB", "1", "Composition of the bottom product"}},
          .mvs = {{"L", "1", "Reflux"}, {"V", "1", "Boilup"}},
          .mds = {},
          .G = {{lag(87.8), lag(-86.4)}, {lag(108.2), lag(-109.6)}}};
}

PlantModel siso_plant() {
  return {.name = "siso",
          .title = "SISO plant of second order with an inverse response",
          .time_unit = "s",
          .cvs = {{"y", "1", "Controlled variable"}},
          .mvs = {{"u", "1", "Manipulated variable"}},
          .mds = {},
          .G = {{TransferFunction(Eigen::Vector2d(-100, 3.04), Eigen::Vector3d(305, 40, 1))}}};
}

PlantModel ogunnaike_ray_column() {
  const auto lag = TransferFunction::first_order;
  // gain (zero s + 1) e^{-dead_time s} / ((a s + 1) (b s + 1))
  const auto lead = [](double gain, double zero, double a, double b, double dead_time) {
    return TransferFunction(gain * Eigen::Vector2d(zero, 1), Eigen::Vector3d(a * b, a + b, 1), dead_time);
  };
  return {.name = "ogunnaike-ray",
          .title = "Ogunnaike and Ray's distillation column, 3 CVs, 3 MVs, 2 measured disturbances",
          .time_unit = "min",
          .cvs = {{"y1", "1", "Ethanol in the overhead product, mole fraction"},
                  {"y2", "1", "Ethanol in the side stream, mole fraction"},
                  {"y3", "degC", "Temperature of tray 19"}},
          .mvs = {{"u1", "gal/min", "Reflux flow"},
                  {"u2", "gal/min", "Side stream flow"},
                  {"u3", "psi", "Steam pressure of the reboiler"}},
          .mds = {{"d1", "gal/min", "Feed flow"}, {"d2", "degC", "Feed temperature"}},
          .G = {{lag(0.66, 6.7, 2.6), lag(-0.61, 8.64, 3.5), lag(-0.0049, 9.06, 1.0), lag(0.14, 6.2, 12.0),
                 lead(-0.0011, 26.32, 7.85, 14.63, 2.66)},
                {lag(1.11, 3.25, 6.5), lag(-2.36, 5.0, 3.0), lag(-0.01, 7.09, 1.2), lag(0.53, 6.9, 10.5),
                 lead(-0.0032, 19.62, 7.29, 8.94, 3.44)},
                {lag(-34.68, 8.15, 9.2), lag(46.2, 10.9, 9.4), lead(0.87, 11.61, 3.89, 18.8, 1.0),
                 lag(-11.54, 7.01, 0.6), lag(0.32, 7.76, 2.6)}}};
}

PlantModel evaporator() {
  // Poles of composition (X) and pressure (P), and slopes through which they act on pressure and level (L).
  constexpr double kX = 0.1, kP = 0.05579782, kXtoP = -0.02090766, kXtoL = 0.004181532, kPtoL = 0.00751231;
  struct Input {
    double x, p, l;  // a column of B
  };
  constexpr std::array<Input, 6> kInputs{{{-1.25, 0, -0.05},
                                          {0, 0.009587532, -0.0019175065},
                                          {0, -0.001828122, 0},
                                          {0.25, 0.016437197, 0.046712561},
                                          {0.5, 0, 0},
                                          {0, 0.0045454545, -0.0009090909}}};
  const TransferFunction none = TransferFunction::zero();
  TransferMatrix G(3, kInputs.size());
  for (std::size_t i = 0; i < kInputs.size(); ++i) {
    const auto [x, p, l] = kInputs[i];
    const auto input = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d both(1, kX + kP, kX * kP);
    if (x == 0) {
      G(1, input) = none;
      G(2, input) = {Eigen::VectorXd::Constant(1, p), Eigen::Vector2d(1, kP)};
      G(0, input) = {Eigen::Vector2d(l, l * kP + kPtoL * p), Eigen::Vector3d(1, kP, 0)};
      continue;
    }
    const Eigen::Vector2d pressure(p, p * kX + kXtoP * x);  // numerator over `both`
    G(1, input) = {Eigen::VectorXd::Constant(1, x), Eigen::Vector2d(1, kX)};
    G(2, input) = {pressure, both};
    G(0, input) = {l * both + kPtoL * Eigen::Vector3d(0, pressure(0), pressure(1)) +
                       kXtoL * x * Eigen::Vector3d(0, 1, kP),
                   Eigen::Vector4d(1, kX + kP, kX * kP, 0)};
  }
  return {.name = "evaporator",
          .title = "Newell and Lee's evaporator with its level, 3 CVs, 3 MVs, 3 measured disturbances",
          .time_unit = "min",
          .cvs = {{"L2", "m", "Level of the separator, integrates"},
                  {"X2", "%", "Composition of the product"},
                  {"P2", "kPa", "Operating pressure"}},
          .mvs = {{"F2", "kg/min", "Flow of the product"},
                  {"P100", "kPa", "Pressure of the steam"},
                  {"F200", "kg/min", "Flow of the cooling water"}},
          .mds = {{"F1", "kg/min", "Flow of the feed"},
                  {"X1", "%", "Composition of the feed"},
                  {"T1", "degC", "Temperature of the feed"}},
          .G = std::move(G)};
}

PlantModel distillation_column_with_levels() {
  constexpr double kLag = 75, kLiquidLag = 2.46;
  const auto composition = [](double gain) { return TransferFunction::first_order(gain, kLag); };
  const auto flow = [](double rate, double dead_time = 0) {
    return TransferFunction(Eigen::VectorXd::Constant(1, rate), Eigen::Vector2d(1, 0), dead_time);
  };
  const TransferFunction none = TransferFunction::zero();
  return {.name = "column-levels",
          .title = "Skogestad's column with both levels, 4 CVs, 4 MVs, 1 measured disturbance",
          .time_unit = "min",
          .cvs = {{"yD", "1", "Light component in the distillate, mole fraction"},
                  {"xB", "1", "Light component in the bottoms, mole fraction"},
                  {"MD", "kmol", "Holdup of the condenser, integrates"},
                  {"MB", "kmol", "Holdup of the reboiler, integrates"}},
          .mvs = {{"L", "kmol/min", "Reflux"},
                  {"V", "kmol/min", "Boilup"},
                  {"D", "kmol/min", "Distillate"},
                  {"B", "kmol/min", "Bottoms"}},
          .mds = {{"F", "kmol/min", "Flow of the feed, liquid"}},
          .G = {{composition(0.878), composition(-0.864), none, none, composition(0.394)},
                {composition(1.082), composition(-1.096), none, none, composition(0.586)},
                {flow(-1), flow(1), flow(-1), none, none},
                {flow(1, kLiquidLag), flow(-1), none, flow(-1), flow(1, kLiquidLag / 2)}}};
}

PlantModel banded_unit_20x8() {
  constexpr int kCvs = 20, kMvs = 8, kMds = 2;
  PlantModel plant{.name = "banded-20x8",
                   .title = "Made-up train of eight places, 20 CVs, 8 MVs, 2 measured disturbances",
                   .time_unit = "min",
                   .cvs = {},
                   .mvs = {},
                   .mds = {},
                   .G = TransferMatrix(kCvs, kMvs + kMds)};
  const auto place_of = [](int i) { return 1.0 + 7.0 * (i - 1) / (kCvs - 1); };
  const auto channel = [](int i, int j, double delta, double scale, double decay) {
    const double sign = (i + j) % 3 == 0 ? -1.0 : 1.0;
    return TransferFunction::first_order(
        sign * scale * (2.0 + (3 * i + 2 * j) % 5 / 4.0) * std::exp(-decay * delta),
        8.0 + 3.0 * ((2 * i + 5 * j) % 8), 1.0 + (i + 3 * j) % 4 + std::round(2.0 * delta));
  };
  for (int i = 1; i <= kCvs; ++i) {
    plant.cvs.push_back({fmt::format("y{}", i), "1", fmt::format("Quality at place {:.2f}", place_of(i))});
    for (int j = 1; j <= kMvs; ++j)
      if (const double delta = std::abs(place_of(i) - j); delta < 2.2)
        plant.G(i - 1, j - 1) = channel(i, j, delta, 1.0, 0.8);
    for (int k = 1; k <= kMds; ++k)
      if (const double delta = std::abs(place_of(i) - (2.5 + 4.0 * (k - 1))); delta < 4.0)
        plant.G(i - 1, kMvs + k - 1) = channel(i, kMvs + k, delta, 0.5, 0.4);
  }
  for (int j = 1; j <= kMvs; ++j)
    plant.mvs.push_back({fmt::format("u{}", j), "1", fmt::format("Duty at place {}", j)});
  plant.mds = {{"d1", "1", "Feed at place 2.5"}, {"d2", "1", "Feed at place 6.5"}};
  return plant;
}

}  // namespace mpm
