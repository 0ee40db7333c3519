#include <array>

#include "results/archive/archive_groups.hpp"
#include "results/archive/columns.hpp"
#include "results/archive/dimensions.hpp"
#include "results/archive/variable_text.hpp"

namespace mpm {
namespace {

constexpr const char* kFindingsGroup = "findings";

using Names = std::vector<std::string>;

/// One value of each item along `dimensions`.
template <class T, class Items, class Get>
void write_each(Hdf5Group& group, const Names& dimensions, const VariableText& text, const Items& items,
                Get get) {
  std::vector<T> values;
  for (const auto& item : items)
    values.push_back(static_cast<T>(get(item)));
  group.write(text.name, dimensions, values, attributes<T>(text));
}

void write_rows(Hdf5Group& group, const std::vector<Finding>& rows) {
  Names names;
  for (const Finding& row : rows)
    names.push_back(row.name);
  const Names along{"finding"};
  group.write_dimension("finding", names,
                        attributes<std::string>({"finding", "name by which studies and gates refer to it"}));
  const auto texts = [&](const VariableText& text, const auto& get) {
    write_each<std::string>(group, along, text, rows, get);
  };
  const auto numbers = [&](const VariableText& text, const auto& get) {
    write_each<double>(group, along, text, rows, get);
  };
  const auto counts = [&](const VariableText& text, const auto& get) {
    write_each<std::int64_t>(group, along, text, rows, get);
  };
  texts({"meaning", "which experiments are looked at, and what of them is counted"},
        [](const Finding& row) { return row.meaning; });
  texts({"kind", "kind of the experiments", "1", "empty: of several kinds"}, [](const Finding& row) {
    return std::string(row.kind ? mpm::to_string(*row.kind) : std::string_view());
  });
  texts({"of_method", "method whose answers they are", "1", "empty: of no method"},
        [](const Finding& row) { return row.method; });
  write_each<std::int8_t>(group, along,
                          {"form", "how it is read", "1", "share: of experiments, 0 to 1",
                           enum_flags(std::array{FindingForm::share, FindingForm::number})},
                          rows, [](const Finding& row) { return row.form; });
  numbers({"value", "measured value", "1", "NaN: nothing was measured"},
          [](const Finding& row) { return row.value; });
  numbers({"lower", "lower end of the interval of the value", "1", "NaN: no interval"},
          [](const Finding& row) { return row.interval.lower; });
  numbers({"upper", "upper end of the interval of the value", "1", "NaN: no interval"},
          [](const Finding& row) { return row.interval.upper; });
  counts({"count", "experiments (or pairs, for regressions) behind the value"},
         [](const Finding& row) { return row.count; });
  counts({"hits", "of a share, experiments that count", "1", "-1: no share"},
         [](const Finding& row) { return row.hits; });
  numbers({"reported", "value reported elsewhere", "1", "NaN where the study names none"},
          [](const Finding& row) { return row.reported; });
}

/// Of the chain: true CV against predicted CV.
void write_confusion(Hdf5Group& group, const Study& study, const std::vector<KindFindings>& kinds) {
  Names names;
  for (const KindFindings& kind : kinds)
    names.emplace_back(mpm::to_string(kind.kind));
  group.write_dimension("fault", names,
                        attributes<std::string>({"fault", "what is wrong in the experiments"}));
  write_variable_dimension(group, "true_cv", "CV that is affected", study.plant.cvs);
  write_variable_dimension(group, "predicted_cv", "CV that Ivar_diag points at", study.plant.cvs);
  std::vector<std::int64_t> counts;
  for (const KindFindings& kind : kinds)
    for (Eigen::Index row = 0; row < study.cv_count(); ++row)
      for (Eigen::Index col = 0; col < study.cv_count(); ++col)
        counts.push_back(kind.confusion.counts()(row, col));
  group.write("confusion", {"fault", "true_cv", "predicted_cv"}, counts,
              attributes<std::int64_t>(
                  {"confusion", "number of impactful experiments of a true CV with a predicted CV"}));
}

void write_pairs(Hdf5Group& group, const StudyFindings& findings) {
  const std::vector<MethodPair>& pairs = findings.pairs;
  std::vector<std::int32_t> numbers;
  for (std::size_t pair = 0; pair < pairs.size(); ++pair)
    numbers.push_back(static_cast<std::int32_t>(pair));
  const Names along{"pair"};
  group.write_dimension("pair", numbers, attributes<std::int32_t>({"pair", "two methods on the same loops"}));
  const auto name = [&](std::size_t method) { return findings.methods[method].name(); };
  write_each<std::string>(group, along, {"first", "first method of the pair"}, pairs,
                          [&](const MethodPair& pair) { return name(pair.first); });
  write_each<std::string>(group, along, {"second", "second method of the pair"}, pairs,
                          [&](const MethodPair& pair) { return name(pair.second); });
  write_each<std::string>(
      group, along,
      {"truth",
       "which loops are to be flagged: those with a fault, or those with a fault that has an impact"},
      pairs, [](const MethodPair& pair) { return std::string(mpm::to_string(pair.truth)); });
  write_each<std::int64_t>(group, along, {"pair_loops", "loops that both gave a verdict on"}, pairs,
                           [](const MethodPair& pair) { return pair.loops; });
  write_each<std::int64_t>(group, along, {"first_alone", "loops that only the first one is right on"}, pairs,
                           [](const MethodPair& pair) { return pair.test.lost; });
  write_each<std::int64_t>(group, along, {"second_alone", "loops that only the second one is right on"},
                           pairs, [](const MethodPair& pair) { return pair.test.gained; });
  write_each<double>(group, along, {"p_two_sided", "exact p-value of McNemar's test, two-sided"}, pairs,
                     [](const MethodPair& pair) { return pair.test.p_two_sided; });
  write_each<double>(group, along,
                     {"p_worse", "exact p-value of McNemar's test of the second one being worse"}, pairs,
                     [](const MethodPair& pair) { return pair.test.p_worse; });
  write_each<double>(group, along, {"p_holm", "p_two_sided corrected for all pairs of its truth (Holm 1979)"},
                     pairs, [](const MethodPair& pair) { return pair.p_holm; });
}

}  // namespace

void write_findings(Hdf5Group& root, const Campaign& campaign, const StudyFindings& findings) {
  Hdf5Group group = root.create_group(kFindingsGroup);
  group.write_attribute("title", "What the experiments show, with intervals");
  group.write_attribute("confidence", campaign.study.aggregate.confidence);
  group.write_attribute("experiments", std::int64_t{findings.experiments});
  group.write_attribute("failed", std::int64_t{findings.failed});
  write_rows(group, findings.rows);
  if (const MethodFindings* const chain = findings.chain(); chain != nullptr && !chain->kinds.empty())
    write_confusion(group, campaign.study, chain->kinds);
  write_pairs(group, findings);
}

}  // namespace mpm
