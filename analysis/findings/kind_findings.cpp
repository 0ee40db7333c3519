#include "analysis/findings/kind_findings.hpp"

#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "scenarios/random_stream.hpp"

namespace mpm {
namespace {

constexpr std::array<double, 5> kDominanceEdges{0.0, 0.3, 0.5, 0.7, 1.0};

/// Pairs (estimate, Ivar_basis) of the CVs [first, last) of the experiments, experiment by experiment.
struct IvarPairs {
  std::vector<double> x, y;
  std::vector<std::int64_t> experiment;

  void add(const ExperimentRecord& record, const Eigen::MatrixXd& estimate, Eigen::Index first,
           Eigen::Index last) {
    for (Eigen::Index cv = first; cv < last; ++cv) {
      x.push_back(estimate(cv));
      y.push_back(record.ivar_basis(cv));
      experiment.push_back(record.draw.index);
    }
  }

  LinearFitIntervals fit(const Study& study, std::uint64_t which) const {
    RandomStream stream(study.seed, which, StreamId::bootstrap);
    const auto size = static_cast<Eigen::Index>(x.size());
    return cluster_bootstrap(Eigen::Map<const Eigen::VectorXd>(x.data(), size),
                             Eigen::Map<const Eigen::VectorXd>(y.data(), size), experiment, stream,
                             {study.aggregate.bootstrap_replications, study.aggregate.confidence});
  }
};

/// The name of the number that estimates Ivar_basis; empty without one.
std::string estimate_name(const AssessmentForm& form) {
  for (const NumberPlace& place : form.places())
    if (place.info.estimates_ivar_basis)
      return place.info.name;
  return {};
}

void fit_regressions(const Study& study, const AssessmentForm& form, std::size_t method,
                     std::span<const ExperimentRecord> records, KindFindings& result) {
  const std::string estimate = estimate_name(form);
  if (estimate.empty())
    return;
  const Eigen::Index ny = study.cv_count();
  IvarPairs all;
  std::vector<IvarPairs> of_cv(static_cast<std::size_t>(ny));
  for (const ExperimentRecord& record : records) {
    if (record.draw.kind != result.kind || !record.assessments[method].answered())
      continue;
    const Eigen::MatrixXd values = record.assessments[method].values(estimate);
    all.add(record, values, 0, ny);
    for (Eigen::Index cv = 0; cv < ny; ++cv)
      of_cv[static_cast<std::size_t>(cv)].add(record, values, cv, cv + 1);
  }
  // A bootstrap stream of its own for every fit, so that no fit depends on which others are made.
  const auto first = static_cast<std::uint64_t>(result.kind) * static_cast<std::uint64_t>(ny + 1);
  result.regression = all.fit(study, first);
  for (Eigen::Index cv = 0; cv < ny; ++cv)
    result.regression_of_cv.push_back(
        of_cv[static_cast<std::size_t>(cv)].fit(study, first + 1 + static_cast<std::uint64_t>(cv)));
}

KindFindings findings_of(const Study& study, const AssessmentForm& form, std::size_t method,
                         std::span<const ExperimentRecord> records, ExperimentKind kind) {
  const double confidence = study.aggregate.confidence;
  const std::vector<const AssessmentNumberInfo*> numbers = summarised_numbers(form);
  KindFindings result;
  result.kind = kind;
  result.confusion = ConfusionMatrix(study.cv_count());
  std::int64_t verdicts = 0, flagged = 0, judged = 0, recognised = 0;
  std::vector<std::vector<double>> values(numbers.size());
  for (const ExperimentRecord& record : records) {
    if (record.draw.kind != kind)
      continue;
    result.add(record.status);
    const AssessmentRecord& said = record.assessments[method];
    if (!said.answered())
      continue;
    ++verdicts;
    flagged += said.flagged ? 1 : 0;
    const Judgement judgement = judge(study, record, said);
    if (judgement.predicted_cv != Correctness::not_judged)
      result.confusion.add(record.draw.true_cv(), said.predicted_cv);
    judged += judgement.source() == Correctness::not_judged ? 0 : 1;
    recognised += judgement.source() == Correctness::right ? 1 : 0;
    if (in_source_population(study, said))
      for (std::size_t n = 0; n < numbers.size(); ++n)
        values[n].push_back(said.number(numbers[n]->name));
  }
  result.finish(confidence);
  result.flagged = rate(flagged, verdicts, confidence);
  result.located = result.confusion.accuracy(confidence);
  result.source_recognised = rate(recognised, judged, confidence);
  for (const std::vector<double>& of_number : values)
    result.summaries.push_back(summarise(of_number, confidence));
  fit_regressions(study, form, method, records, result);
  return result;
}

void append_regression(const LinearFitIntervals& fit, const Finding& like, const std::string& prefix,
                       const std::string& over, std::vector<Finding>& rows) {
  const auto row = [&](const char* name, const char* word, double value, const Interval& interval) {
    Finding finding = like.with(value, interval, fit.fit.pairs);
    finding.name = prefix + name;
    finding.label = fmt::format("{} of Ivar_{{basis}} on Ivar{}", word, over.empty() ? "" : ", " + over);
    finding.meaning = fmt::format("{} of Ivar_basis on Ivar, {}", word[0] == 'R' ? "R^2" : word,
                                  over.empty() ? "all CVs" : over);
    rows.push_back(std::move(finding));
  };
  row("r_squared", "R\xC2\xB2", fit.fit.r_squared, fit.r_squared);
  row("slope", "slope", fit.fit.slope, fit.slope);
  row("intercept", "intercept", fit.fit.intercept, fit.intercept);
  rows.back().prominence = Prominence::detail;
}

/// A plot label as plain text: "I_{MPM}" is "I_MPM".
std::string without_marks(std::string label) {
  std::erase_if(label, [](char c) { return c == '{' || c == '}'; });
  return label;
}

}  // namespace

std::vector<KindFindings> kind_findings(const Study& study, const AssessmentForm& form, std::size_t method,
                                        std::span<const ExperimentRecord> records) {
  std::vector<KindFindings> kinds;
  for (const ExperimentKind kind : {ExperimentKind::mpm, ExperimentKind::ud, ExperimentKind::mpm_ud})
    if (study.experiments.of(kind) > 0)
      kinds.push_back(findings_of(study, form, method, records, kind));
  return kinds;
}

std::vector<const AssessmentNumberInfo*> summarised_numbers(const AssessmentForm& form) {
  std::vector<const AssessmentNumberInfo*> numbers;
  for (const NumberPlace& place : form.places())
    if (place.info.summarised)
      numbers.push_back(&place.info);
  return numbers;
}

std::vector<Finding> rows_of(const KindFindings& kind, const Study& study, const AssessmentForm& form,
                             const std::string& prefix) {
  const std::string of = fmt::format("{}{}.", prefix, to_string(kind.kind));
  const MethodDescription& method = form.method();
  const auto like = [&](const char* name, const char* label, const char* meaning,
                        Prominence prominence = Prominence::table) {
    return Finding{.name = of + name,
                   .label = label,
                   .meaning = meaning,
                   .group = FindingGroup::kind,
                   .prominence = prominence,
                   .kind = kind.kind,
                   .method = method.name};
  };
  std::vector<Finding> rows{
      counted(like("experiments", "experiments", "number of experiments", Prominence::detail),
              kind.experiments),
      counted(like("failed", "failed", "number of experiments without a result", Prominence::detail),
              kind.failed),
      like("infeasible", "infeasible", "share of infeasible experiments").with(kind.infeasible),
      prefix.empty()
          ? like("impactful", "with impact", "share of impactful ones among the feasible").with(kind.flagged)
          : like("flagged", "flagged", "share of flagged ones among those with a verdict")
                .with(kind.flagged)};
  const Finding regression = like("", "", "");
  if (!kind.regression_of_cv.empty()) {
    append_regression(kind.regression, regression, of, "", rows);
    rows[rows.size() - 3].prominence = Prominence::headline;
  }
  if (method.locates_cvs)
    rows.push_back(like("located", "CV located",
                        prefix.empty() ? "CV located by Ivar_diag, impactful experiments"
                                       : "the affected CV has the largest score, flagged experiments",
                        Prominence::headline)
                       .with(kind.located));
  if (method.tells_sources && kind.kind != ExperimentKind::mpm_ud)
    rows.push_back(like("source_recognised", "source recognised",
                        prefix.empty() ? "I_MPM on the right side of its threshold"
                                       : "the CV with the largest score has the right source",
                        Prominence::headline)
                       .with(kind.source_recognised));
  const std::vector<const AssessmentNumberInfo*> numbers = summarised_numbers(form);
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    Finding number = like("", numbers[n]->label.c_str(), without_marks(numbers[n]->label).c_str());
    number.name = of + numbers[n]->name;
    for (Finding& row : summary_findings(number, kind.summaries[n]))
      rows.push_back(std::move(row));
  }
  Finding detail = regression;
  detail.prominence = Prominence::detail;
  for (std::size_t cv = 0; cv < kind.regression_of_cv.size(); ++cv)
    append_regression(kind.regression_of_cv[cv], detail, fmt::format("{}{}.", of, study.plant.cvs[cv].name),
                      study.plant.cvs[cv].name, rows);
  return rows;
}

std::vector<DominanceBin> dominance_bins(const Study& study, std::size_t method,
                                         std::span<const ExperimentRecord> records) {
  std::vector<DominanceBin> bins;
  if (study.experiments.mpm_ud == 0)
    return bins;
  for (std::size_t b = 0; b + 1 < kDominanceEdges.size(); ++b) {
    const double lower = kDominanceEdges[b];
    const double upper = kDominanceEdges[b + 1];
    const bool last = b + 2 == kDominanceEdges.size();
    std::vector<double> i_mpm;
    std::int64_t above = 0;
    for (const ExperimentRecord& record : records) {
      const AssessmentRecord& said = record.assessments[method];
      if (record.draw.kind != ExperimentKind::mpm_ud || !in_source_population(study, said))
        continue;
      const double dominance = said.number("dominance_mpm");
      if (!(dominance >= lower && (dominance < upper || (last && dominance <= upper))))
        continue;
      i_mpm.push_back(said.number("i_mpm"));
      above += i_mpm.back() > study.diagnosis.mpm_threshold ? 1 : 0;
    }
    bins.push_back({lower, upper, summarise(i_mpm, study.aggregate.confidence),
                    rate(above, static_cast<std::int64_t>(i_mpm.size()), study.aggregate.confidence)});
  }
  return bins;
}

std::vector<Finding> rows_of(const std::vector<DominanceBin>& bins) {
  std::vector<Finding> rows;
  for (const DominanceBin& bin : bins) {
    const Finding mean{
        .name = fmt::format("mpm_ud.i_mpm_mean_at_dominance_{:g}_to_{:g}", bin.lower, bin.upper),
        .label = fmt::format("mean I_{{MPM}} at dominance {:g} to {:g}", bin.lower, bin.upper),
        .meaning = fmt::format("mean I_MPM at dominance {:g} to {:g}", bin.lower, bin.upper),
        .group = FindingGroup::dominance,
        .kind = ExperimentKind::mpm_ud};
    rows.push_back(mean.with(bin.i_mpm.mean, bin.i_mpm.mean_interval, bin.i_mpm.count));
    Finding above = mean;
    above.name = fmt::format("mpm_ud.i_mpm_above_threshold_at_dominance_{:g}_to_{:g}", bin.lower, bin.upper);
    above.label =
        fmt::format("I_{{MPM}} above its threshold at dominance {:g} to {:g}", bin.lower, bin.upper);
    above.meaning =
        fmt::format("share of experiments with I_MPM above its threshold at dominance {:g} to {:g}",
                    bin.lower, bin.upper);
    above.prominence = Prominence::detail;
    rows.push_back(above.with(bin.above_threshold));
  }
  return rows;
}

}  // namespace mpm
