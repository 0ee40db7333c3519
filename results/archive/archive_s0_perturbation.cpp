#include <cstdint>

#include <fmt/format.h>

#include "analysis/basis/s0_perturbation_structure.hpp"
#include "analysis/findings/s0_perturbation_curves.hpp"
#include "results/archive/archive_groups.hpp"
#include "results/archive/dimensions.hpp"
#include "results/archive/variable_text.hpp"

namespace mpm {
namespace {

constexpr const char* kPerturbationGroup = "s0_perturbation";

/// One number of each item along `dimension`.
template <class Item, class Get>
void write_each(Hdf5Group& group, const std::string& dimension, const VariableText& text,
                const std::vector<Item>& items, Get get) {
  std::vector<double> values;
  for (const Item& item : items)
    values.push_back(get(item));
  group.write(text.name, {dimension}, values, attributes<double>(text));
}

/// A dimension along the CVs of the items.
template <class Item>
void write_cv_dimension(Hdf5Group& group, const std::string& name, const std::string& long_name,
                        const Study& study, const std::vector<Item>& items) {
  std::vector<PlantModel::Variable> cvs;
  for (const Item& item : items)
    cvs.push_back(study.plant.cvs[static_cast<std::size_t>(item.cv)]);
  write_variable_dimension(group, name, long_name, cvs);
}

void write_fits(Hdf5Group& group, const Study& study, const NominalSensitivity& sensitivity) {
  const std::vector<DiagonalFit> fits = diagonal_fits(sensitivity, study.controller.sample_time);
  const std::string time = unit_text(study.plant.time_unit);
  const std::string along = "active_cv";
  write_cv_dimension(group, along, "CV at a soft limit", study, fits);
  write_each(group, along, {"time_constant", "time constant of the fit to T0", time, "NaN: no fit"}, fits,
             [](const DiagonalFit& f) { return f.fit.model.time_constant; });
  write_each(group, along, {"damping", "damping of the fit to T0", "1", "NaN: no fit"}, fits,
             [](const DiagonalFit& f) { return f.fit.model.damping; });
  write_each(group, along, {"fit_error", "root mean squared error of the fit to T0", "1", "NaN: no fit"},
             fits, [](const DiagonalFit& f) { return f.fit.rms_error; });
}

void write_structure(Hdf5Group& group, const Study& study, const BasisCase& basis) {
  const std::vector<StructureFit> fits = structure_fits(study, basis);
  const std::string time = unit_text(study.plant.time_unit);
  const std::string along = "fixed_active_cv";
  write_cv_dimension(group, along, "CV at a soft limit with and without the fixed MVs", study, fits);
  write_each(group, along,
             {"fixed_time_constant", "time constant of the fit with fixed MVs", time, "NaN: no fit"}, fits,
             [](const StructureFit& f) { return f.fixed.model.time_constant; });
  write_each(group, along, {"fixed_damping", "damping of the fit with fixed MVs", "1", "NaN: no fit"}, fits,
             [](const StructureFit& f) { return f.fixed.model.damping; });
  write_each(
      group, along,
      {"time_constant_multiplier", "time constant with fixed MVs over that without", "1", "NaN: no fit"},
      fits, [](const StructureFit& f) { return f.time_constant_multiplier; });
  write_each(group, along,
             {"damping_multiplier", "damping with fixed MVs over that without", "1", "NaN: no fit"}, fits,
             [](const StructureFit& f) { return f.damping_multiplier; });
}

void write_spreads(Hdf5Group& group, const std::string& name, const std::string& parameter,
                   const std::vector<S0Curve>& curves, std::vector<RatioSpread> S0Curve::*member) {
  const auto number = [&](const char* suffix, const char* word, double RatioSpread::*value) {
    std::vector<double> values;
    for (const S0Curve& curve : curves)
      for (const RatioSpread& spread : curve.*member)
        values.push_back(spread.*value);
    const VariableText text{
        "ratio_" + name + suffix,
        fmt::format("{} of Ivar_diag modified over true, {} of S0 multiplied", word, parameter), "1",
        "NaN: no experiment has such a ratio"};
    group.write(text.name, {"perturbed_cv", "multiplier"}, values, attributes<double>(text));
  };
  number("_min", "smallest", &RatioSpread::least);
  number("_lower_quartile", "lower quartile", &RatioSpread::lower_quartile);
  number("_median", "median", &RatioSpread::median);
  number("_upper_quartile", "upper quartile", &RatioSpread::upper_quartile);
  number("_max", "largest", &RatioSpread::largest);
}

void write_curves(Hdf5Group& group, const Study& study, const RecordRange& records) {
  const std::vector<S0Curve> curves = s0_curve_collector(study).of(records);
  write_cv_dimension(group, "perturbed_cv", "affected CV", study, curves);
  std::vector<std::int64_t> counts;
  for (const S0Curve& curve : curves)
    counts.push_back(curve.experiments);
  group.write("experiments", {"perturbed_cv"}, counts,
              attributes<std::int64_t>({"experiments", "number of experiments behind the ratios"}));
  write_spreads(group, "time_constant", "time constant", curves, &S0Curve::time_constant);
  write_spreads(group, "damping", "damping", curves, &S0Curve::damping);
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
