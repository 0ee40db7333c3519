#include <utility>

#include "analysis/study_aggregate.hpp"
#include "results/archive_groups.hpp"
#include "results/dimensions.hpp"
#include "results/reference.hpp"
#include "results/variable_text.hpp"

namespace mpm {
namespace {

/// Writes one number of every element of a list.
template <class T, class List, class Get>
void write_of(Hdf5Group& group, const std::vector<std::string>& dimensions, const VariableText& text,
              const List& list, const Get& get) {
  std::vector<T> values;
  for (const auto& element : list)
    values.push_back(get(element));
  group.write(text.name, dimensions, values, attributes<T>(text));
}

void write_named_values(Hdf5Group& group, const Study& study, const StudyAggregate& total) {
  const std::vector<AggregateValue> values = named_values(total);
  std::vector<std::string> names;
  for (const AggregateValue& value : values)
    names.push_back(value.name);
  group.write_dimension("aggregate", names, attributes<std::string>({"aggregate", "name of the number"}));
  const std::vector<std::string> along{"aggregate"};
  write_of<std::string>(group, along, {"description", "what the number is"}, values,
                        [](const auto& v) { return v.description; });
  write_of<double>(group, along, {"value", "point estimate"}, values, [](const auto& v) { return v.value; });
  write_of<double>(group, along, {"lower", "lower end of the interval", "1", "NaN: no interval"}, values,
                   [](const auto& v) { return v.interval.lower; });
  write_of<double>(group, along, {"upper", "upper end of the interval", "1", "NaN: no interval"}, values,
                   [](const auto& v) { return v.interval.upper; });
  write_of<std::int64_t>(group, along, {"count", "experiments (pairs, for regressions) behind the number"},
                         values, [](const auto& v) { return v.count; });
  write_of<double>(group, along, {"reported", "number that the study's reference reports", "1", "NaN: none"},
                   values, [&](const auto& v) { return reference_value(study, v.name); });
}

void write_confusion(Hdf5Group& group, const StudyAggregate& total) {
  std::vector<std::int64_t> counts;
  for (const KindAggregate& kind : total.kinds)
    for (Eigen::Index i = 0; i < kind.confusion.classes(); ++i)
      for (Eigen::Index j = 0; j < kind.confusion.classes(); ++j)
        counts.push_back(kind.confusion.counts()(i, j));
  const VariableText text{"confusion", "impactful experiments by true CV and CV located by Ivar_diag"};
  group.write(text.name, {"kind", "cv", "predicted_cv"}, counts, attributes<std::int64_t>(text));
}

/// Regressions of Ivar_basis on Ivar: element 0 over all CVs, the others CV by CV.
void write_regressions(Hdf5Group& group, const StudyAggregate& total) {
  std::vector<const LinearFitIntervals*> fits;
  for (const KindAggregate& kind : total.kinds) {
    fits.push_back(&kind.regression);
    for (const LinearFitIntervals& fit : kind.regression_of_cv)
      fits.push_back(&fit);
  }
  struct Part {
    const char* name;
    double LinearFit::*value;
    Interval LinearFitIntervals::*interval;
  };
  const std::vector<std::string> along{"kind", "regression_cv"};
  for (const Part part : {Part{"slope", &LinearFit::slope, &LinearFitIntervals::slope},
                          Part{"intercept", &LinearFit::intercept, &LinearFitIntervals::intercept},
                          Part{"r_squared", &LinearFit::r_squared, &LinearFitIntervals::r_squared}}) {
    const std::string name = std::string("regression_") + part.name;
    const std::string what = std::string(part.name) + " of Ivar_basis on Ivar";
    write_of<double>(group, along, {name, what}, fits, [&](const auto* fit) { return fit->fit.*part.value; });
    write_of<double>(group, along, {name + "_lower", what + ", lower end"}, fits,
                     [&](const auto* fit) { return (fit->*part.interval).lower; });
    write_of<double>(group, along, {name + "_upper", what + ", upper end"}, fits,
                     [&](const auto* fit) { return (fit->*part.interval).upper; });
  }
  write_of<std::int64_t>(group, along, {"regression_pairs", "pairs in the regression"}, fits,
                         [](const auto* fit) { return static_cast<std::int64_t>(fit->fit.pairs); });
}

void write_dominance(Hdf5Group& group, const std::vector<DominanceBin>& bins) {
  std::vector<double> centre;
  for (const DominanceBin& bin : bins)
    centre.push_back(0.5 * (bin.lower + bin.upper));
  group.write_dimension("dominance", centre,
                        attributes<double>({"dominance", "middle of the bin of dominance_mpm"}));
  const std::vector<std::string> along{"dominance"};
  const auto write = [&](const char* name, const char* what, auto get) {
    write_of<double>(group, along, {name, what}, bins, get);
  };
  write("dominance_lower", "lower edge of the bin", [](const auto& b) { return b.lower; });
  write("dominance_upper", "upper edge of the bin", [](const auto& b) { return b.upper; });
  write("dominance_i_mpm_mean", "mean I_MPM in the bin", [](const auto& b) { return b.i_mpm.mean; });
  write("dominance_i_mpm_mean_lower", "its lower end",
        [](const auto& b) { return b.i_mpm.mean_interval.lower; });
  write("dominance_i_mpm_mean_upper", "its upper end",
        [](const auto& b) { return b.i_mpm.mean_interval.upper; });
  write("dominance_above_threshold", "share with I_MPM above its threshold",
        [](const auto& b) { return b.above_threshold.value; });
  write_of<std::int64_t>(group, along, {"dominance_count", "experiments in the bin"}, bins,
                         [](const auto& b) { return b.i_mpm.count; });
}

}  // namespace

void write_aggregate(Hdf5Group& root, const Campaign& campaign) {
  const Study& study = campaign.study;
  const StudyAggregate total = aggregate(study, campaign.records);
  Hdf5Group group = root.create_group("aggregate");
  group.write_attribute("confidence", study.aggregate.confidence);
  group.write_attribute("experiments", total.experiments);
  group.write_attribute("failed", total.failed);
  write_named_values(group, study, total);

  std::vector<std::string> kinds;
  for (const KindAggregate& kind : total.kinds)
    kinds.emplace_back(to_string(kind.kind));
  group.write_dimension("kind", kinds, attributes<std::string>({"kind", "kind of the experiments"}));
  write_variable_dimension(group, "cv", "true controlled variable", study.plant.cvs);
  write_variable_dimension(group, "predicted_cv", "located controlled variable", study.plant.cvs);
  std::vector<PlantModel::Variable> regressions{{"all", "", "all controlled variables together"}};
  regressions.insert(regressions.end(), study.plant.cvs.begin(), study.plant.cvs.end());
  write_variable_dimension(group, "regression_cv", "controlled variables in the regression", regressions);
  write_confusion(group, total);
  write_regressions(group, total);
  if (!total.dominance.empty())
    write_dominance(group, total.dominance);
}

}  // namespace mpm
