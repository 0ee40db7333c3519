#include <algorithm>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "analysis/sensitivity/box_jenkins_sensitivity.hpp"
#include "results/archive/archive_groups.hpp"
#include "results/archive/dimensions.hpp"
#include "results/archive/row_io.hpp"
#include "results/files/archive_error.hpp"

namespace mpm {
namespace {

constexpr const char* kNominalGroup = "nominal";
constexpr const char* kFixedGroup = "nominal_fixed";
constexpr const char* kDirectGroup = "nominal_direct";

/// The response to a step of one CV that is held.
struct SteppedCv {
  ConstraintKind side = ConstraintKind::lower_limit;
  Eigen::MatrixXd response = {};
};

std::vector<Row<SteppedCv>> stepped_rows(const Study& study, Eigen::Index lags) {
  return {member_row<std::int8_t>(
              {"side", "soft limit or setpoint of the CV", "1", "", numbered({"lower", "upper", "setpoint"})},
              &SteppedCv::side),
          matrix_row<SteppedCv>(
              {"t0_step_response", "response of cv to a unit step of the limit or setpoint of active_cv", "1",
               "in the unit of cv per unit of active_cv; stays at its last value"},
              {"cv", "lag"}, study.cv_count(), lags, &SteppedCv::response)
              .along("time")};
}

Eigen::Index position(const Study& study, const std::string& name, const char* group,
                      const std::string& file) {
  const auto& cvs = study.plant.cvs;
  const auto found = std::find_if(cvs.begin(), cvs.end(), [&](const auto& cv) { return cv.name == name; });
  if (found == cvs.end())
    throw ArchiveError(fmt::format("{}: dimension '/{}/active_cv': found '{}', which is no CV of the study",
                                   file, group, name));
  return found - cvs.begin();
}

void write_sensitivity(Hdf5Group& group, const std::string& title, const Study& study,
                       const NominalSensitivity& sensitivity) {
  group.write_attribute("title", title);
  std::vector<PlantModel::Variable> active;
  std::vector<SteppedCv> stepped;
  for (std::size_t a = 0; a < sensitivity.active.size(); ++a) {
    active.push_back(study.plant.cvs[static_cast<std::size_t>(sensitivity.active[a].cv)]);
    stepped.push_back({sensitivity.active[a].kind, sensitivity.step_response[a]});
  }
  const Eigen::Index lags = stepped.empty() ? study.sensitivity.samples : stepped.front().response.cols();
  write_variable_dimension(group, "active_cv", "CV at a soft limit or a setpoint, which is stepped", active);
  write_variable_dimension(group, "cv", "controlled variable", study.plant.cvs);
  write_sample_dimension(group, "lag", "samples after the step", "time", study, 1, lags);
  store_rows(group, {"active_cv"}, stepped_rows(study, lags), stepped);
}

NominalSensitivity read_sensitivity(const Hdf5Group& root, const char* name, const Study& study,
                                    const std::string& file) {
  const Hdf5Group group = root.group(name);
  const std::vector<std::string> active = group.read_list<std::string>("active_cv");
  const auto lags = static_cast<Eigen::Index>(group.read_list<std::int32_t>("lag").size());
  std::vector<SteppedCv> stepped(active.size());
  load_rows(group, stepped_rows(study, lags), stepped, file);
  NominalSensitivity sensitivity;
  sensitivity.cv_count = study.cv_count();
  for (std::size_t a = 0; a < active.size(); ++a) {
    sensitivity.active.push_back({position(study, active[a], name, file), stepped[a].side});
    sensitivity.step_response.push_back(stepped[a].response);
  }
  return sensitivity;
}

}  // namespace

void write_nominal(Hdf5Group& root, const Study& study, const NominalSensitivity& sensitivity) {
  Hdf5Group group = root.create_group(kNominalGroup);
  write_sensitivity(group, "Nominal complementary sensitivity T0; S0 = I - T0, and T0 = 0 from other CVs",
                    study, sensitivity);
  group.write_attribute("known", std::int32_t{sensitivity.is_known});
}

NominalSensitivity read_nominal(const Hdf5Group& root, const Study& study, const std::string& file) {
  const Hdf5Group group = root.group(kNominalGroup);
  NominalSensitivity sensitivity = read_sensitivity(root, kNominalGroup, study, file);
  sensitivity.is_known =
      !group.has_attribute("known") || group.attribute<std::int32_t>("known") != 0;  // from 2.1 on
  return sensitivity;
}

void write_nominal_fixed(Hdf5Group& root, const Study& study,
                         const std::optional<NominalSensitivity>& sensitivity) {
  if (!sensitivity)
    return;
  Hdf5Group group = root.create_group(kFixedGroup);
  write_sensitivity(group, "T0 with the fixed MVs of s0_perturbation held", study, *sensitivity);
}

void write_nominal_direct(Hdf5Group& root, const Study& study, const BasisCase& basis) {
  if (!basis.sensitivity_direct)
    return;
  Hdf5Group group = root.create_group(kDirectGroup);
  write_sensitivity(group, "T0 as direct step responses, beside the identified one of /nominal", study,
                    *basis.sensitivity_direct);
  const Eigen::VectorXd largest = largest_differences(basis.sensitivity, *basis.sensitivity_direct);
  store_rows<double>(group, {"active_cv"},
                     {member_row<double, double>(
                         {"largest_difference", "largest difference of identified and direct step responses",
                          "1", "in the units of t0_step_response"},
                         [](auto& number) -> auto& { return number; })},
                     {largest.begin(), largest.end()});
}

std::optional<NominalSensitivity> read_nominal_direct(const Hdf5Group& root, const Study& study,
                                                      const NominalSensitivity& identified,
                                                      const std::string& file) {
  if (study.sensitivity.form != SensitivityForm::box_jenkins)
    return std::nullopt;
  NominalSensitivity direct = read_sensitivity(root, kDirectGroup, study, file);
  const auto shape = [](const NominalSensitivity& sensitivity) {
    const auto& responses = sensitivity.step_response;
    return std::pair(sensitivity.active, responses.empty() ? 0 : responses.front().cols());
  };
  if (shape(direct) != shape(identified))
    throw ArchiveError(fmt::format("{}: '/{}': found other references or lags; allowed: those of '/{}'", file,
                                   kDirectGroup, kNominalGroup));
  return direct;
}

std::optional<NominalSensitivity> read_nominal_fixed(const Hdf5Group& root, const Study& study,
                                                     const std::string& file) {
  if (study.s0_perturbation.fixed_mvs.empty())
    return std::nullopt;
  return read_sensitivity(root, kFixedGroup, study, file);
}

}  // namespace mpm
