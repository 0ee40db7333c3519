#include "plants/linear/plant_model.hpp"

#include <set>

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {
namespace {

void require_text(const std::string& quantity, const std::string& text) {
  if (text.empty()) {
    throw InputError(quantity, "an empty text", "a text");
  }
}

void require_new_names(const std::vector<PlantModel::Variable>& variables, const std::string& plant,
                       std::set<std::string>& known) {
  for (const PlantModel::Variable& variable : variables) {
    require_text(fmt::format("variable name of plant '{}'", plant), variable.name);
    if (!known.insert(variable.name).second) {
      throw InputError(fmt::format("variable name of plant '{}'", plant),
                       fmt::format("'{}' twice", variable.name), "every name once");
    }
  }
}

}  // namespace

void PlantModel::validate() const {
  require_text("plant name", name);
  require_text(fmt::format("time unit of plant '{}'", name), time_unit);
  if (cvs.empty() || mvs.empty()) {
    throw InputError(fmt::format("size of plant '{}'", name),
                     fmt::format("{} CVs and {} MVs", cvs.size(), mvs.size()), "at least one of each");
  }
  std::set<std::string> known;
  require_new_names(cvs, name, known);
  require_new_names(mvs, name, known);
  require_new_names(mds, name, known);

  const auto rows = static_cast<Eigen::Index>(cvs.size());
  const auto cols = static_cast<Eigen::Index>(mvs.size() + mds.size());
  if (G.rows() != rows || G.cols() != cols) {
    throw InputError(fmt::format("transfer matrix of plant '{}'", name),
                     fmt::format("{} x {}", G.rows(), G.cols()),
                     fmt::format("{} x {} (CVs x MVs and MDs)", rows, cols));
  }
}

std::vector<std::string> variable_names(const std::vector<PlantModel::Variable>& variables) {
  std::vector<std::string> names;
  for (const PlantModel::Variable& variable : variables)
    names.push_back(variable.name);
  return names;
}

std::vector<std::string> input_names(const PlantModel& plant) {
  std::vector<std::string> names = variable_names(plant.mvs);
  for (const PlantModel::Variable& md : plant.mds)
    names.push_back(md.name);
  return names;
}

}  // namespace mpm
