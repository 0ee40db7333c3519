#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace mpm {

/// The parameters of the quadruple-tank process (Johansson 2000), tank i at index i - 1.
///
/// | symbol | member      | unit             | names for with_parameter |
/// |--------|-------------|------------------|--------------------------|
/// | A_i    | area        | cm^2             | A1 ... A4                |
/// | cd_i   | discharge   | cm^(3 - exp_i)/s | cd1 ... cd4              |
/// | exp_i  | exponent    |                  | exp1 ... exp4            |
/// | k_j    | pump        | cm^3 / (V s)     | k1, k2                   |
struct QuadrupleTankParameters {
  std::array<double, 4> area;
  std::array<double, 4> discharge;
  std::array<double, 4> exponent;
  std::array<double, 2> pump;

  /// Errors: InputError naming the parameter that is not positive, or the exponent that is not below 2.
  void validate() const;
};

/// A parameter set of the thesis: "table-2.6", or "table-3.1", which table 5.9 repeats. They differ in k_1,
/// k_2, A_2 and A_3. The printed linear model (2.31), (3.29), (5.29) belongs to table 2.6. Errors: InputError
/// for another name; the text lists the known ones.
QuadrupleTankParameters quadruple_tank_parameters(const std::string& name);

/// The names that quadruple_tank_parameters() knows.
std::vector<std::string> quadruple_tank_parameter_sets();

/// The parameters by name, "A1" ... "k2".
std::vector<std::pair<std::string, double>> named_parameters(const QuadrupleTankParameters& parameters);

/// A copy with another value of one parameter: a model-plant mismatch as in tables 2.8, 3.9 and 5.11 (M1 is
/// with_parameter(p, "cd2", 6.47)). Errors: InputError for an unknown name or a value out of range.
QuadrupleTankParameters with_parameter(const QuadrupleTankParameters& parameters, const std::string& name,
                                       double value);

}  // namespace mpm
