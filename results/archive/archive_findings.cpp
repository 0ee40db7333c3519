
#include "results/archive/archive_groups.hpp"
#include "results/archive/dimensions.hpp"
#include "results/archive/row_io.hpp"

namespace mpm {
namespace {

constexpr const char* kFindingsGroup = "findings";

using Names = std::vector<std::string>;

void write_finding_rows(Hdf5Group& group, const std::vector<Finding>& findings) {
  Names names;
  for (const Finding& finding : findings)
    names.push_back(finding.name);
  group.write_dimension("finding", names,
                        attributes<std::string>({"finding", "name by which studies and gates refer to it"}));
  using F = Finding;
  const std::vector<Row<F>> rows{
      member_row<std::string>({"heading", "heading in tables and figures", "1", "empty: none"}, &F::label),
      member_row<std::string>({"meaning", "which experiments the number covers, and what it counts"},
                              &F::meaning),
      value_row<std::string, F>(
          {"kind", "kind of the experiments", "1", "empty: of several kinds"},
          [](const F& finding) { return std::string(finding.kind ? to_string(*finding.kind) : ""); }),
      member_row<std::string>({"of_method", "method whose answers are counted", "1", "empty: of no method"},
                              &F::method),
      member_row<std::int8_t>(
          {"form", "how it is read", "1", "share: of experiments, 0 to 1", enum_words<FindingForm>()},
          &F::form),
      member_row<double>({"value", "measured value", "1", "NaN: nothing was measured"}, &F::value),
      member_row<double, F>({"lower", "lower end of the interval of the value", "1", "NaN: no interval"},
                            path(&F::interval, &Interval::lower)),
      member_row<double, F>({"upper", "upper end of the interval of the value", "1", "NaN: no interval"},
                            path(&F::interval, &Interval::upper)),
      member_row<std::int64_t>({"count", "experiments (or pairs, for regressions) behind the value"},
                               &F::count),
      member_row<std::int64_t>({"hits", "of a share, experiments that count", "1", "-1: no share"}, &F::hits),
      member_row<double>({"reported", "value reported elsewhere", "1", "NaN where the study names none"},
                         &F::reported)};
  store_rows(group, {"finding"}, rows, findings);
}

/// Writes the confusion matrix of the chain: true CV against predicted CV.
void write_confusion(Hdf5Group& group, const Study& study, const std::vector<KindFindings>& kinds) {
  Names names;
  for (const KindFindings& kind : kinds)
    names.emplace_back(to_string(kind.kind));
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
  group.write_dimension("pair", numbers, attributes<std::int32_t>({"pair", "two methods on the same loops"}));
  using P = MethodPair;
  const auto name = [&](const char* variable, const char* meaning, std::size_t P::*method) {
    return value_row<std::string, P>({variable, meaning}, [&findings, method](const P& pair) {
      return findings.methods[pair.*method].name();
    });
  };
  const std::vector<Row<P>> rows{
      name("first", "first method of the pair", &P::first),
      name("second", "second method of the pair", &P::second),
      value_row<std::string, P>(
          {"truth",
           "loops that should be flagged: those with a fault, or those with a fault that has an impact"},
          [](const P& pair) { return std::string(to_string(pair.truth)); }),
      member_row<std::int64_t>({"pair_loops", "loops on which both gave a verdict"}, &P::loops),
      member_row<std::int64_t, P>({"first_alone", "loops on which only the first method is right"},
                                  path(&P::test, &McNemarTest::lost)),
      member_row<std::int64_t, P>({"second_alone", "loops on which only the second method is right"},
                                  path(&P::test, &McNemarTest::gained)),
      member_row<double, P>({"p_two_sided", "exact p-value of McNemar's test, two-sided"},
                            path(&P::test, &McNemarTest::p_two_sided)),
      member_row<double, P>({"p_worse", "exact p-value of McNemar's test of the second one being worse"},
                            path(&P::test, &McNemarTest::p_worse)),
      member_row<double>({"p_holm", "p_two_sided corrected for all pairs of its truth (Holm 1979)"},
                         &P::p_holm)};
  store_rows(group, {"pair"}, rows, pairs);
}

}  // namespace

void write_findings(Hdf5Group& root, const Campaign& campaign, const StudyFindings& findings) {
  Hdf5Group group = root.create_group(kFindingsGroup);
  group.write_attribute("title", "What the experiments show, with intervals");
  group.write_attribute("confidence", campaign.study.aggregate.confidence);
  group.write_attribute("experiments", std::int64_t{findings.experiments});
  group.write_attribute("failed", std::int64_t{findings.failed});
  write_finding_rows(group, findings.rows);
  if (const MethodFindings* const chain = findings.chain(); chain != nullptr && !chain->kinds.empty())
    write_confusion(group, campaign.study, chain->kinds);
  write_pairs(group, findings);
}

}  // namespace mpm
