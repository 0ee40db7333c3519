#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/s0_perturbation_structure.hpp"
#include "analysis/findings/s0_perturbation_curves.hpp"
#include "results/archive/archive_groups.hpp"
#include "results/archive/dimensions.hpp"
#include "results/archive/row_io.hpp"

namespace mpm {
namespace {

constexpr const char* kPerturbationGroup = "s0_perturbation";

/// Writes a dimension along the CVs of the items.
template <class Item>
void write_cv_dimension(Hdf5Group& group, const std::string& name, const std::string& long_name,
                        const Study& study, const std::vector<Item>& items) {
  std::vector<PlantModel::Variable> cvs;
  for (const Item& item : items)
    cvs.push_back(study.plant.cvs[static_cast<std::size_t>(item.cv)]);
  write_variable_dimension(group, name, long_name, cvs);
}

template <class Fit>
Row<Fit> fit_row(const char* name, const char* meaning, const std::string& unit, auto... lens) {
  return member_row<double, Fit>({name, meaning, unit, "NaN: no fit"}, path(lens...));
}

void write_fits(Hdf5Group& group, const Study& study, const NominalSensitivity& sensitivity) {
  const std::vector<DiagonalFit> fits = diagonal_fits(sensitivity, study.controller.sample_time);
  const char* const along = "active_cv";
  const auto model = path(&DiagonalFit::fit, &SecondOrderFit::model);
  write_cv_dimension(group, along, "CV at a soft limit", study, fits);
  store_rows<DiagonalFit>(
      group, {along},
      {fit_row<DiagonalFit>("time_constant", "time constant of the fit to T0",
                            unit_text(study.plant.time_unit), model, &SecondOrderModel::time_constant),
       fit_row<DiagonalFit>("damping", "damping of the fit to T0", "1", model, &SecondOrderModel::damping),
       fit_row<DiagonalFit>("fit_error", "root mean squared error of the fit to T0", "1", &DiagonalFit::fit,
                            &SecondOrderFit::rms_error)},
      fits);
}

void write_structure(Hdf5Group& group, const Study& study, const BasisCase& basis) {
  using F = StructureFit;
  const std::vector<F> fits = structure_fits(study, basis);
  const char* const along = "fixed_active_cv";
  const auto model = path(&F::fixed, &SecondOrderFit::model);
  write_cv_dimension(group, along, "CV at a soft limit with and without the fixed MVs", study, fits);
  store_rows<F>(group, {along},
                {fit_row<F>("fixed_time_constant", "time constant of the fit with fixed MVs",
                            unit_text(study.plant.time_unit), model, &SecondOrderModel::time_constant),
                 fit_row<F>("fixed_damping", "damping of the fit with fixed MVs", "1", model,
                            &SecondOrderModel::damping),
                 fit_row<F>("time_constant_multiplier", "time constant with fixed MVs over that without", "1",
                            &F::time_constant_multiplier),
                 fit_row<F>("damping_multiplier", "damping with fixed MVs over that without", "1",
                            &F::damping_multiplier)},
                fits);
}

void append_spreads(const Study& study, const std::string& name, const std::string& parameter,
                    std::vector<RatioSpread> S0Curve::*member, std::vector<Row<S0Curve>>& rows) {
  const auto add = [&](const char* suffix, const char* word, double RatioSpread::*value) {
    rows.push_back(of_each<S0Curve>(
        member_row<double>(
            {"ratio_" + name + suffix,
             fmt::format("{} of Ivar_diag modified over true, {} of S0 multiplied", word, parameter), "1",
             "NaN: no experiment has such a ratio"},
            value),
        "multiplier", study.s0_perturbation.multipliers.size(), member));
  };
  add("_min", "smallest", &RatioSpread::least);
  add("_lower_quartile", "lower quartile", &RatioSpread::lower_quartile);
  add("_median", "median", &RatioSpread::median);
  add("_upper_quartile", "upper quartile", &RatioSpread::upper_quartile);
  add("_max", "largest", &RatioSpread::largest);
}

void write_curves(Hdf5Group& group, const Study& study, const RecordRange& records) {
  const std::vector<S0Curve> curves = s0_curve_collector(study).of(records);
  write_cv_dimension(group, "perturbed_cv", "affected CV", study, curves);
  std::vector<Row<S0Curve>> rows{member_row<std::int64_t>(
      {"experiments", "number of experiments behind the ratios"}, &S0Curve::experiments)};
  append_spreads(study, "time_constant", "time constant", &S0Curve::time_constant, rows);
  append_spreads(study, "damping", "damping", &S0Curve::damping, rows);
  store_rows(group, {"perturbed_cv"}, rows, curves);
}

}  // namespace

void write_s0_perturbation(Hdf5Group& root, const Campaign& campaign) {
  const Study& study = campaign.study;
  if (study.s0_perturbation.multipliers.empty())
    return;
  Hdf5Group group = root.group(kPerturbationGroup);
  write_curves(group, study, records_of(campaign));
  write_fits(group, study, campaign.basis.sensitivity);
  write_structure(group, study, campaign.basis);
}

}  // namespace mpm
