#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "plants/models/catalogue.hpp"
#include "plants/non_finite.hpp"
#include "scenarios/files/study_file_keys.hpp"
#include "scenarios/files/study_file_parts.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

// Bounds on what a file can make the program allocate; far above any plant of the literature.
constexpr std::size_t kMaxVariables = 200;
constexpr std::size_t kMaxCoefficients = 20;

/// The variables of one list, with names that none of `known` has; adds them to `known`.
std::vector<PlantModel::Variable> read_variables(const TomlTable& plant, const std::string& list,
                                                 std::set<std::string>& known) {
  const std::vector<TomlTable> tables = plant.tables(list, study_file_keys("plant." + list + "[]"));
  if (tables.size() > kMaxVariables) {
    plant.refuse(list, fmt::format("{} variables", tables.size()), fmt::format("at most {}", kMaxVariables));
  }
  std::vector<PlantModel::Variable> variables;
  for (const TomlTable& table : tables) {
    PlantModel::Variable variable{.name = read_name(table, "name"),
                                  .unit = read_text(table, "unit"),
                                  .description = read_text_or(table, "description", "")};
    if (!known.insert(variable.name).second) {
      table.refuse("name", fmt::format("'{}' for a second variable", variable.name), "every name once");
    }
    variables.push_back(std::move(variable));
  }
  return variables;
}

/// Largest real part of the roots of p_0 s^n + ... + p_n, n >= 1, p_0 != 0, by the companion matrix. The unit
/// of s is chosen so that the geometric mean of the roots is 1; without that, slow multiple roots would drown
/// in rounding. Not finite when the ratios of the coefficients are not.
double largest_real_part_of_roots(const Eigen::VectorXd& p) {
  const Eigen::Index n = p.size() - 1;
  const double mean_root = std::pow(std::abs(p(n) / p(0)), 1.0 / static_cast<double>(n));
  if (mean_root == 0) {
    return 0;
  }
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    companion(0, i) = -p(i + 1) / p(0) / std::pow(mean_root, static_cast<double>(i + 1));
  }
  companion.diagonal(-1).setOnes();
  if (!companion.allFinite()) {
    return kNaN;
  }
  return mean_root * companion.eigenvalues().real().maxCoeff();
}

void read_channels(const TomlTable& plant, PlantModel& model) {
  const std::vector<std::string> cvs = variable_names(model.cvs);
  std::vector<std::string> inputs = variable_names(model.mvs);
  const std::vector<std::string> mds = variable_names(model.mds);
  inputs.insert(inputs.end(), mds.begin(), mds.end());

  model.G = TransferMatrix(static_cast<Eigen::Index>(cvs.size()), static_cast<Eigen::Index>(inputs.size()));
  std::set<std::pair<Eigen::Index, Eigen::Index>> listed;
  for (const TomlTable& table : plant.tables("channel", study_file_keys("plant.channel[]"))) {
    const auto row = static_cast<Eigen::Index>(read_one_of(table, "cv", cvs));
    const auto col = static_cast<Eigen::Index>(read_one_of(table, "input", inputs));
    const TransferFunction channel = read_transfer_function(table);
    refuse_unstable(table, channel);
    if (!listed.emplace(row, col).second) {
      table.refuse("", "a second channel from this input to this CV", "every channel once");
    }
    model.G(row, col) = channel;
  }
}

/// A mismatch changes a channel from an MV to a CV, so there must be one.
void refuse_without_mv_channel(const TomlTable& plant, const PlantModel& model) {
  for (Eigen::Index row = 0; row < model.G.rows(); ++row) {
    for (std::size_t mv = 0; mv < model.mvs.size(); ++mv) {
      if (!model.G(row, static_cast<Eigen::Index>(mv)).is_zero()) {
        return;
      }
    }
  }
  plant.refuse("channel", "no channel from an MV that is not zero", "at least one");
}

PlantModel read_inline_plant(const TomlTable& plant) {
  std::set<std::string> known;
  PlantModel model;
  model.name = read_name(plant, "name");
  model.title = read_text(plant, "title");
  model.time_unit = read_text(plant, "time_unit");
  model.cvs = read_variables(plant, "cv", known);
  model.mvs = read_variables(plant, "mv", known);
  if (plant.has("md")) {
    model.mds = read_variables(plant, "md", known);
  }
  read_channels(plant, model);
  refuse_without_mv_channel(plant, model);
  plant.located("", [&] { return model.validate(); });
  return model;
}

}  // namespace

TransferFunction read_transfer_function(const TomlTable& table) {
  const double dead_time = read_number_or(table, "dead_time", NumberRule::at_least(0), 0.0);
  const bool first_order = table.has("gain") || table.has("time_constant");
  if (first_order == (table.has("numerator") || table.has("denominator"))) {
    table.refuse("", first_order ? "both ways to write a channel" : "no transfer function",
                 "either gain and time_constant, or numerator and denominator");
  }
  if (first_order) {
    return TransferFunction::first_order(read_number(table, "gain", NumberRule::finite()),
                                         read_number(table, "time_constant", NumberRule::positive()),
                                         dead_time);
  }
  Eigen::VectorXd numerator = read_numbers(table, "numerator", NumberRule::finite(), kMaxCoefficients);
  Eigen::VectorXd denominator = read_numbers(table, "denominator", NumberRule::finite(), kMaxCoefficients);
  return table.located(
      "", [&] { return TransferFunction(std::move(numerator), std::move(denominator), dead_time); });
}

void refuse_unstable(const TomlTable& table, const TransferFunction& channel) {
  if (channel.is_zero() || channel.order() == 0) {
    return;
  }
  const double real_part = largest_real_part_of_roots(channel.denominator());
  if (!std::isfinite(real_part)) {
    table.refuse("denominator", "coefficients whose ratios overflow", "coefficients of similar size");
  }
  if (!(real_part < 0)) {
    table.refuse("denominator", fmt::format("a pole with real part {:.3g}", real_part),
                 "poles with negative real parts");
  }
}

void refuse_growing(const TomlTable& table, const TransferFunction& Gd) {
  const Eigen::VectorXd& all = Gd.denominator();
  Eigen::Index size = all.size();
  while (size > 1 && all(size - 1) == 0) {
    --size;  // an integrator
  }
  if (Gd.is_zero() || size == 1) {
    return;
  }
  const double real_part = largest_real_part_of_roots(all.head(size));
  if (!std::isfinite(real_part)) {
    table.refuse("denominator", "coefficients whose ratios overflow", "coefficients of similar size");
  }
  if (real_part > 0) {
    table.refuse("denominator", fmt::format("a pole with real part {:.3g}", real_part),
                 "poles with negative real parts, or at 0");
  }
}

std::vector<std::string> variable_names(const std::vector<PlantModel::Variable>& variables) {
  std::vector<std::string> names;
  std::transform(variables.begin(), variables.end(), std::back_inserter(names),
                 [](const PlantModel::Variable& variable) { return variable.name; });
  return names;
}

PlantModel read_plant(const TomlTable& document) {
  const TomlTable plant = document.table("plant", study_file_keys("plant"));
  if (!plant.has("catalogue")) {
    return read_inline_plant(plant);
  }
  for (const char* key : {"name", "title", "time_unit", "cv", "mv", "md", "channel"}) {
    if (plant.has(key)) {
      plant.refuse(key, "a key beside catalogue", "catalogue alone, or an own plant without it");
    }
  }
  const std::vector<std::string> names = benchmark_plant_names();
  return benchmark_plant(names[read_one_of(plant, "catalogue", names)]);
}

}  // namespace mpm
