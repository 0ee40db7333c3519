#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/findings/method_rates.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/method_words.hpp"
#include "results/archive/archive_groups.hpp"
#include "results/archive/column_io.hpp"
#include "results/archive/dimensions.hpp"
#include "results/archive/record_subset.hpp"
#include "results/files/archive_error.hpp"

namespace mpm {
namespace {

constexpr const char* kGroup = "comparison";
/// Not "method": `sel(method=...)` of xarray means something else, and would select nothing without a word.
constexpr const char* kMethod = "assessment_method";
constexpr const char* kChannels = "flagged_channel";

/// The verdicts method by method, each in the order of the experiments.
template <class OneComparison>
auto verdicts_of(OneComparison& comparison) {
  std::vector<decltype(&comparison.loops.front().verdicts.front())> verdicts;
  for (std::size_t method = 0; method < comparison.methods.size(); ++method)
    for (auto& loop : comparison.loops)
      verdicts.push_back(&loop.verdicts[method]);
  return verdicts;
}

void write_methods(Hdf5Group& group, const Comparison& comparison) {
  group.write_dimension(kMethod, comparison.methods,
                        attributes<std::string>({kMethod, "method of assessment"}));
  const auto text = [&](const char* name, const char* long_name, const auto& of_method) {
    std::vector<std::string> texts;
    for (const std::string& method : comparison.methods)
      texts.push_back(of_method(assessment_method(method)));
    group.write(name, {kMethod}, texts, attributes<std::string>({name, long_name}));
  };
  text("title", "the method as people cite it", [](const AssessmentMethodInfo& m) { return m.title; });
  text("verdict", "what a flagged loop is", [](const AssessmentMethodInfo& m) { return m.verdict; });
  text("needs", "what the method needs of a loop", needs_text);
  text("answers", "what the method tells besides its verdict", answers_text);
  group.write("reason", {kMethod}, comparison.reasons,
              attributes<std::string>({"reason", "why there was no verdict, of the first loop without one",
                                       "1", "empty when there always was one"}));
}

void write_channels(Hdf5Group& group, const Study& study, const std::vector<const MethodVerdict*>& verdicts) {
  const auto ny = static_cast<std::size_t>(study.cv_count()), nu = static_cast<std::size_t>(study.mv_count());
  std::vector<std::int8_t> flags(verdicts.size() * ny * nu, 0);
  for (std::size_t i = 0; i < verdicts.size(); ++i)
    for (const Channel& channel : verdicts[i]->flagged_channels)
      flags[(i * ny + static_cast<std::size_t>(channel.cv)) * nu + static_cast<std::size_t>(channel.mv)] = 1;
  const VariableText text{kChannels, "the method names this channel of the model", "1", "", yes_no_flags()};
  group.write(kChannels, {kMethod, "experiment", "cv", "mv"}, flags, attributes<std::int8_t>(text));
}

void read_channels(const Hdf5Group& group, const Study& study, const std::vector<MethodVerdict*>& verdicts,
                   std::vector<std::size_t> shape, const std::string& file) {
  const Eigen::Index ny = study.cv_count(), nu = study.mv_count();
  shape.push_back(static_cast<std::size_t>(ny));
  shape.push_back(static_cast<std::size_t>(nu));
  const std::vector<std::int8_t> flags = group.read<std::int8_t>(kChannels, shape);
  require_flags<std::int8_t>({kChannels, "", "1", "", yes_no_flags()}, flags, file);
  auto flag = flags.begin();
  for (MethodVerdict* verdict : verdicts)
    for (Eigen::Index cv = 0; cv < ny; ++cv)
      for (Eigen::Index mv = 0; mv < nu; ++mv)
        if (*flag++ != 0)
          verdict->flagged_channels.push_back({cv, mv});
}

/// Numbers along `dimensions`, in the order in which they are appended.
template <class T>
class Variable {
 public:
  explicit Variable(VariableText text) : text_(std::move(text)) {}
  void add(T value) { values_.push_back(value); }
  void write(Hdf5Group& group, const std::vector<std::string>& dimensions) const {
    group.write(text_.name, dimensions, values_, attributes<T>(text_));
  }

 private:
  VariableText text_;
  std::vector<T> values_;
};

void write_rates(Hdf5Group& group, const std::vector<MethodRates>& methods) {
  std::vector<std::string> names, meanings;
  for (const MethodRateInfo& info : method_rate_infos()) {
    names.emplace_back(info.name);
    meanings.emplace_back(info.meaning);
  }
  group.write_dimension("rate", names, attributes<std::string>({"rate", "share of loops"}));
  group.write("description", {"rate"}, meanings,
              attributes<std::string>({"description", "which loops are looked at, and which of them count"}));
  Variable<double> value({"value", "measured share", "1", "NaN: no loop was looked at"});
  Variable<double> lower({"lower", "lower end of the interval of the share"});
  Variable<double> upper({"upper", "upper end of the interval of the share"});
  Variable<std::int64_t> hits({"hits", "loops that count"});
  Variable<std::int64_t> total({"total", "loops looked at"});
  for (const MethodRates& method : methods)
    for (const MethodRateInfo& info : method_rate_infos()) {
      const Rate& rate = method.*info.rate;
      value.add(rate.value);
      lower.add(rate.interval.lower);
      upper.add(rate.interval.upper);
      hits.add(rate.hits);
      total.add(rate.total);
    }
  for (const Variable<double>& variable : {value, lower, upper})
    variable.write(group, {kMethod, "rate"});
  for (const Variable<std::int64_t>& variable : {hits, total})
    variable.write(group, {kMethod, "rate"});
}

void write_scores(Hdf5Group& group, const std::vector<MethodRates>& methods) {
  const std::string comment = "loops with a fault against healthy ones; NaN without one of the two";
  Variable<double> area({"roc_area", "area under the ROC curve of the score", "1", comment});
  Variable<double> lower({"roc_area_lower", "lower end of the interval of the area", "1", comment});
  Variable<double> upper({"roc_area_upper", "upper end of the interval of the area", "1", comment});
  Variable<double> cost({"milliseconds", "median processor time of a verdict", "ms",
                         "differs from run to run; NaN: no verdict"});
  for (const MethodRates& method : methods) {
    area.add(method.roc.area);
    lower.add(method.roc_area.lower);
    upper.add(method.roc_area.upper);
    cost.add(method.milliseconds);
  }
  for (const Variable<double>& variable : {area, lower, upper, cost})
    variable.write(group, {kMethod});
}

void write_pairs(Hdf5Group& group, const ComparisonSummary& summary) {
  const std::vector<MethodPair>& pairs = summary.pairs;
  std::vector<std::int32_t> numbers(pairs.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  group.write_dimension("pair", numbers, attributes<std::int32_t>({"pair", "two methods on the same loops"}));
  std::vector<std::string> first, second, truth;
  Variable<std::int64_t> loops({"pair_loops", "loops that both gave a verdict on"});
  Variable<std::int64_t> lost({"first_alone", "loops that only the first one is right on"});
  Variable<std::int64_t> gained({"second_alone", "loops that only the second one is right on"});
  Variable<double> two_sided({"p_two_sided", "exact p-value of McNemar's test, two-sided"});
  Variable<double> worse({"p_worse", "exact p-value of McNemar's test of the second one being worse"});
  for (const MethodPair& pair : pairs) {
    first.push_back(summary.methods[pair.first].method);
    second.push_back(summary.methods[pair.second].method);
    truth.emplace_back(to_string(pair.truth));
    loops.add(pair.loops);
    lost.add(pair.test.lost);
    gained.add(pair.test.gained);
    two_sided.add(pair.test.p_two_sided);
    worse.add(pair.test.p_worse);
  }
  group.write("first", {"pair"}, first, attributes<std::string>({"first", "first method of the pair"}));
  group.write("second", {"pair"}, second, attributes<std::string>({"second", "second method of the pair"}));
  group.write("truth", {"pair"}, truth,
              attributes<std::string>({"truth",
                                       "which loops are to be flagged: those with a fault, or those "
                                       "with a fault that has an impact"}));
  for (const Variable<std::int64_t>& variable : {loops, lost, gained})
    variable.write(group, {"pair"});
  for (const Variable<double>& variable : {two_sided, worse})
    variable.write(group, {"pair"});
}

/// Throws ArchiveError for a method that this program does not have.
void require_known(const std::vector<std::string>& methods, const std::string& file) {
  const std::vector<std::string> known = assessment_method_names();
  for (const std::string& method : methods)
    if (std::find(known.begin(), known.end(), method) == known.end())
      throw ArchiveError(fmt::format("{}: dimension '/{}/{}': found '{}'; allowed: {}", file, kGroup, kMethod,
                                     method, fmt::join(known, ", ")));
}

}  // namespace

void write_comparison(Hdf5Group& root, const Campaign& campaign) {
  if (!campaign.comparison)
    return;
  const Study& study = campaign.study;
  const Comparison& comparison = *campaign.comparison;
  const ComparisonInfo& info = campaign.comparison_info;
  Hdf5Group group = root.create_group(kGroup);
  group.write_attribute("title", "What methods of assessment say of the loops, and how often they are right");
  group.write_attribute("mpmbench_version", info.mpmbench_version);
  group.write_attribute("git_sha", info.git_sha);
  group.write_attribute("command", info.command);
  group.write_attribute("confidence", study.aggregate.confidence);
  write_methods(group, comparison);
  std::vector<std::int64_t> experiments;
  for (const ComparedLoop& loop : comparison.loops)
    experiments.push_back(loop.experiment);
  group.write_dimension("experiment", experiments,
                        attributes<std::int64_t>({"experiment", "index of the experiment in the study"}));
  write_variable_dimension(group, "cv", "controlled variable", study.plant.cvs);
  write_variable_dimension(group, "mv", "manipulated variable", study.plant.mvs);
  const std::vector<const MethodVerdict*> verdicts = verdicts_of(comparison);
  write_columns(group, {kMethod, "experiment"}, method_verdict_columns(study), verdicts);
  write_channels(group, study, verdicts);
  const ComparisonSummary summary = summarise(comparison, campaign.records, study);
  write_rates(group, summary.methods);
  write_scores(group, summary.methods);
  write_pairs(group, summary);
}

void read_comparison(const Hdf5Group& root, Campaign& campaign, const std::string& file) {
  if (!root.has_group(kGroup))
    return;
  const Hdf5Group group = root.group(kGroup);
  campaign.comparison_info = {group.attribute<std::string>("mpmbench_version"),
                              group.attribute<std::string>("git_sha"),
                              group.attribute<std::string>("command")};
  Comparison comparison;
  comparison.methods = group.read_list<std::string>(kMethod);
  require_known(comparison.methods, file);
  const std::size_t methods = comparison.methods.size();
  comparison.reasons = group.read<std::string>("reason", {methods});
  for (const ExperimentRecord* record : records_along(group, kGroup, "experiment", campaign.records, file))
    comparison.loops.push_back({record->draw.index, std::vector<MethodVerdict>(methods)});
  const std::vector<MethodVerdict*> verdicts = verdicts_of(comparison);
  const std::vector<std::size_t> shape{methods, comparison.loops.size()};
  read_columns(group, shape, method_verdict_columns(campaign.study), verdicts, file);
  read_channels(group, campaign.study, verdicts, shape, file);
  campaign.comparison = std::move(comparison);
}

}  // namespace mpm
