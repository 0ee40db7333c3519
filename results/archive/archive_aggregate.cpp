#include <cstdint>
#include <limits>
#include <string>

#include "analysis/findings/reference.hpp"
#include "analysis/findings/study_aggregate.hpp"
#include "results/archive/archive_groups.hpp"
#include "results/archive/dimensions.hpp"
#include "results/archive/variable_text.hpp"

namespace mpm {
namespace {

constexpr const char* kGroup = "aggregate";

/// Dimensions, and one value an entry of their product.
using Names = std::vector<std::string>;

void write_numbers(Hdf5Group& group, const Names& dimensions, const VariableText& text,
                   const std::vector<double>& values) {
  group.write(text.name, dimensions, values, attributes<double>(text));
}

void write_counts(Hdf5Group& group, const Names& dimensions, const VariableText& text,
                  const std::vector<std::int64_t>& values) {
  group.write(text.name, dimensions, values, attributes<std::int64_t>(text));
}

void write_texts(Hdf5Group& group, const Names& dimensions, const VariableText& text, const Names& values) {
  group.write(text.name, dimensions, values, attributes<std::string>(text));
}

/// One number of each item.
template <class T, class Item, class Get>
std::vector<T> each(const std::vector<Item>& items, Get get) {
  std::vector<T> values;
  values.reserve(items.size());
  for (const Item& item : items)
    values.push_back(get(item));
  return values;
}

void write_interval(Hdf5Group& group, const Names& dimensions, const VariableText& text,
                    const std::vector<Interval>& intervals) {
  write_numbers(group, dimensions, {text.name + "_lower", text.long_name + ", lower end of the interval"},
                each<double>(intervals, [](const Interval& i) { return i.lower; }));
  write_numbers(group, dimensions, {text.name + "_upper", text.long_name + ", upper end of the interval"},
                each<double>(intervals, [](const Interval& i) { return i.upper; }));
}

void write_rates(Hdf5Group& group, const Names& dimensions, const VariableText& text,
                 const std::vector<Rate>& rates) {
  write_numbers(group, dimensions, text, each<double>(rates, [](const Rate& r) { return r.value; }));
  write_interval(group, dimensions, text, each<Interval>(rates, [](const Rate& r) { return r.interval; }));
  write_counts(group, dimensions, {text.name + "_hits", text.long_name + ", experiments that count"},
               each<std::int64_t>(rates, [](const Rate& r) { return r.hits; }));
  write_counts(group, dimensions, {text.name + "_total", text.long_name + ", experiments looked at"},
               each<std::int64_t>(rates, [](const Rate& r) { return r.total; }));
}

void write_samples(Hdf5Group& group, const Names& dimensions, const VariableText& text,
                   const std::vector<SampleSummary>& samples) {
  const auto number = [&](const std::string& suffix, const std::string& word, double SampleSummary::*member) {
    write_numbers(group, dimensions, {text.name + suffix, word + text.long_name},
                  each<double>(samples, [&](const SampleSummary& s) { return s.*member; }));
  };
  number("_min", "smallest ", &SampleSummary::least);
  number("_mean", "mean ", &SampleSummary::mean);
  number("_max", "largest ", &SampleSummary::largest);
  write_interval(group, dimensions, {text.name + "_mean", "mean " + text.long_name},
                 each<Interval>(samples, [](const SampleSummary& s) { return s.mean_interval; }));
  write_counts(group, dimensions, {text.name + "_count", text.long_name + ", experiments"},
               each<std::int64_t>(samples, [](const SampleSummary& s) { return s.count; }));
}

/// The headline numbers, each in a row with its name.
void write_named_values(Hdf5Group& group, const Study& study, const StudyAggregate& aggregate) {
  const std::vector<AggregateValue> values = named_values(aggregate);
  group.write_dimension("name", each<std::string>(values, [](const auto& v) { return v.name; }),
                        attributes<std::string>({"name", "name of the number"}));
  const Names along{"name"};
  write_texts(group, along, {"description", "what the number is"},
              each<std::string>(values, [](const auto& v) { return v.description; }));
  write_numbers(group, along, {"value", "measured value"},
                each<double>(values, [](const auto& v) { return v.value; }));
  write_numbers(group, along, {"lower", "lower end of the interval of the value", "1", "NaN: no interval"},
                each<double>(values, [](const auto& v) { return v.interval.lower; }));
  write_numbers(group, along, {"upper", "upper end of the interval of the value", "1", "NaN: no interval"},
                each<double>(values, [](const auto& v) { return v.interval.upper; }));
  write_counts(group, along, {"count", "experiments (or pairs, for regressions) behind the value"},
               each<std::int64_t>(values, [](const auto& v) { return v.count; }));
  write_numbers(group, along,
                {"reference", "value reported elsewhere", "1", "NaN where the study names none"},
                each<double>(values, [&](const auto& v) { return reference_value(study, v.name); }));
}

void write_kinds(Hdf5Group& group, const std::vector<KindAggregate>& kinds) {
  group.write_dimension(
      "kind", each<std::string>(kinds, [](const auto& k) { return std::string(to_string(k.kind)); }),
      attributes<std::string>({"kind", "what is wrong in the experiments"}));
  const Names along{"kind"};
  write_counts(group, along, {"experiments", "number of experiments"},
               each<std::int64_t>(kinds, [](const auto& k) { return k.experiments; }));
  write_counts(group, along, {"failed", "number of failed experiments"},
               each<std::int64_t>(kinds, [](const auto& k) { return k.failed; }));
  const auto rates = [&](const VariableText& text, Rate KindAggregate::*member) {
    write_rates(group, along, text, each<Rate>(kinds, [&](const KindAggregate& k) { return k.*member; }));
  };
  rates({"infeasible", "share of infeasible experiments"}, &KindAggregate::infeasible);
  rates({"impactful", "share of impactful experiments among the feasible"}, &KindAggregate::impactful);
  rates({"located", "share of impactful experiments whose CV is located"}, &KindAggregate::located);
  rates({"source_recognised", "share of experiments whose source is recognised", "1",
         "NaN for experiments with both faults"},
        &KindAggregate::source_recognised);
  write_samples(group, along, {"i_mpm", "I_MPM"},
                each<SampleSummary>(kinds, [](const auto& k) { return k.i_mpm; }));
}

void write_confusion(Hdf5Group& group, const Study& study, const std::vector<KindAggregate>& kinds) {
  write_variable_dimension(group, "true_cv", "CV that is affected", study.plant.cvs);
  write_variable_dimension(group, "predicted_cv", "CV that Ivar_diag points at", study.plant.cvs);
  std::vector<std::int64_t> counts;
  for (const KindAggregate& kind : kinds)
    for (Eigen::Index row = 0; row < study.cv_count(); ++row)
      for (Eigen::Index col = 0; col < study.cv_count(); ++col)
        counts.push_back(kind.confusion.counts()(row, col));
  write_counts(group, {"kind", "true_cv", "predicted_cv"},
               {"confusion", "number of impactful experiments of a true CV with a predicted CV"}, counts);
}

void write_regressions(Hdf5Group& group, const Study& study, const std::vector<KindAggregate>& kinds) {
  Names over{"all CVs"};
  for (const PlantModel::Variable& cv : study.plant.cvs)
    over.push_back(cv.name);
  group.write_dimension(
      "regression", over,
      attributes<std::string>({"regression", "CVs whose pairs (Ivar, Ivar_basis) are fitted"}));
  std::vector<LinearFitIntervals> fits;
  for (const KindAggregate& kind : kinds) {
    fits.push_back(kind.regression);
    fits.insert(fits.end(), kind.regression_of_cv.begin(), kind.regression_of_cv.end());
  }
  const Names along{"kind", "regression"};
  const auto number = [&](const VariableText& text, double LinearFit::*value,
                          Interval LinearFitIntervals::*interval) {
    write_numbers(group, along, text,
                  each<double>(fits, [&](const LinearFitIntervals& f) { return f.fit.*value; }));
    write_interval(group, along, text,
                   each<Interval>(fits, [&](const LinearFitIntervals& f) { return f.*interval; }));
  };
  number({"slope", "slope of Ivar_basis on Ivar"}, &LinearFit::slope, &LinearFitIntervals::slope);
  number({"intercept", "intercept of Ivar_basis on Ivar"}, &LinearFit::intercept,
         &LinearFitIntervals::intercept);
  number({"r_squared", "R^2 of Ivar_basis on Ivar"}, &LinearFit::r_squared, &LinearFitIntervals::r_squared);
  write_counts(group, along, {"pairs", "number of pairs in the fit"},
               each<std::int64_t>(fits, [](const auto& f) { return f.fit.pairs; }));
  write_counts(group, along, {"pairs_left_out", "number of pairs left out because one is not finite"},
               each<std::int64_t>(fits, [](const auto& f) { return f.fit.left_out; }));
  write_counts(group, along, {"clusters", "number of experiments with a pair in the fit"},
               each<std::int64_t>(fits, [](const auto& f) { return f.clusters; }));
  write_counts(group, along, {"replications", "number of bootstrap resamples behind the intervals"},
               each<std::int64_t>(fits, [](const auto& f) { return f.replications_used; }));
}

void write_dominance(Hdf5Group& group, const std::vector<DominanceBin>& bins) {
  std::vector<double> lower = each<double>(bins, [](const auto& bin) { return bin.lower; });
  group.write_dimension("dominance", lower,
                        attributes<double>({"dominance", "lower edge of a bin of dominance_mpm"}));
  const Names along{"dominance"};
  write_numbers(group, along, {"dominance_upper", "upper edge of a bin of dominance_mpm"},
                each<double>(bins, [](const auto& bin) { return bin.upper; }));
  write_samples(group, along, {"dominance_i_mpm", "I_MPM at this dominance"},
                each<SampleSummary>(bins, [](const auto& bin) { return bin.i_mpm; }));
  write_rates(group, along,
              {"dominance_above_threshold", "share of experiments with I_MPM above its threshold"},
              each<Rate>(bins, [](const auto& bin) { return bin.above_threshold; }));
}

void write_false_alarms(Hdf5Group& group, const std::vector<FalseAlarms>& groups) {
  group.write_dimension("faultless", each<std::string>(groups, [](const auto& g) { return g.name(); }),
                        attributes<std::string>({"faultless", "experiments in which model and plant agree"}));
  const Names along{"faultless"};
  write_counts(group, along, {"faultless_experiments", "number of experiments"},
               each<std::int64_t>(groups, [](const auto& g) { return g.experiments; }));
  write_counts(group, along, {"faultless_failed", "number of failed experiments"},
               each<std::int64_t>(groups, [](const auto& g) { return g.failed; }));
  const auto rates = [&](const VariableText& text, Rate FalseAlarms::*member) {
    write_rates(group, along, text, each<Rate>(groups, [&](const FalseAlarms& g) { return g.*member; }));
  };
  rates({"faultless_infeasible", "share of infeasible experiments"}, &FalseAlarms::infeasible);
  rates({"false_alarm", "share of experiments with impact among the feasible"}, &FalseAlarms::false_alarm);
  rates({"false_mpm", "share of feasible experiments whose false alarm is a mismatch"},
        &FalseAlarms::false_mpm);
  rates({"false_ud", "share of feasible experiments whose false alarm is a disturbance"},
        &FalseAlarms::false_ud);
}

}  // namespace

void write_aggregate(Hdf5Group& root, const Campaign& campaign) {
  const Study& study = campaign.study;
  const StudyAggregate all = aggregate(study, campaign.records);
  Hdf5Group group = root.create_group(kGroup);
  group.write_attribute("title", "What the experiments show, with intervals");
  group.write_attribute("confidence", study.aggregate.confidence);
  group.write_attribute("experiments", std::int64_t{all.experiments});
  group.write_attribute("failed", std::int64_t{all.failed});
  write_named_values(group, study, all);
  write_kinds(group, all.kinds);
  write_confusion(group, study, all.kinds);
  write_regressions(group, study, all.kinds);
  if (!all.dominance.empty())
    write_dominance(group, all.dominance);
  if (!all.false_alarms.empty())
    write_false_alarms(group, all.false_alarms);
}

}  // namespace mpm
