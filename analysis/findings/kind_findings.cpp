#include "analysis/findings/kind_findings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "scenarios/random/random_stream.hpp"

namespace mpm {
namespace {

constexpr std::array<double, 5> kDominanceEdges{0.0, 0.3, 0.5, 0.7, 1.0};

/// Pairs (estimate, Ivar_basis) of all CVs of the experiments, experiment by experiment.
class IvarPairs {
 public:
  void add(const ExperimentRecord& record, const Eigen::MatrixXd& estimate) {
    for (Eigen::Index cv = 0; cv < estimate.rows(); ++cv) {
      x_.push_back(estimate(cv));
      y_.push_back(record.ivar_basis(cv));
    }
    experiments_.push_back(record.draw.index);
  }

  LinearFitIntervals fit(const Study& study, std::uint64_t which) const {
    std::vector<std::int64_t> cluster;
    cluster.reserve(x_.size());
    for (const std::int64_t experiment : experiments_)
      cluster.insert(cluster.end(), x_.size() / experiments_.size(), experiment);
    return fit(study, which, cluster, 0, 1);
  }
  /// Fits the pairs of one of `ny` CVs.
  LinearFitIntervals fit_of(std::size_t cv, std::size_t ny, const Study& study, std::uint64_t which) const {
    return fit(study, which, experiments_, cv, ny);
  }

 private:
  /// Fits every `stride`-th pair from `first` on.
  LinearFitIntervals fit(const Study& study, std::uint64_t which, std::span<const std::int64_t> cluster,
                         std::size_t first, std::size_t stride) const {
    using Pairs = Eigen::Map<const Eigen::VectorXd, 0, Eigen::InnerStride<>>;
    RandomStream stream(study.seed, which, StreamId::bootstrap);
    const auto size = static_cast<Eigen::Index>(cluster.size());
    const Eigen::InnerStride<> step(static_cast<Eigen::Index>(stride));
    const auto every = [&](const std::vector<double>& values) {
      return Pairs(size > 0 ? &values[first] : nullptr, size, step);
    };
    return cluster_bootstrap(every(x_), every(y_), cluster, stream,
                             {study.aggregate.bootstrap_replications, study.aggregate.confidence});
  }

  std::vector<double> x_, y_;
  std::vector<std::int64_t> experiments_;
};

/// Whether any condition of the loop that can be a cause is known.
bool some_known(const LoopConditions& conditions) {
  return !std::isnan(conditions.spectral_radius) || !std::isnan(conditions.other_cv_active) ||
         !std::isnan(conditions.mv_at_limit);
}

/// The pairs of the experiments that do not have the cause `cause`.
struct PairsWithoutCause {
  NonlinearCause cause;
  std::int64_t experiments = 0;
  std::vector<double> x = {}, y = {};

  void add(const ExperimentRecord& record, const Eigen::MatrixXd& estimate) {
    if (cause == NonlinearCause::none ? !has_cause(record.conditions, cause)
                                      : has_cause(record.conditions, cause)) {
      ++experiments;
      return;
    }
    for (Eigen::Index cv = 0; cv < estimate.rows(); ++cv) {
      x.push_back(estimate(cv));
      y.push_back(record.ivar_basis(cv));
    }
  }
  KindFindings::WithoutCause result() const {
    using Pairs = Eigen::Map<const Eigen::VectorXd>;
    const auto size = static_cast<Eigen::Index>(x.size());
    return {cause, experiments, linear_fit(Pairs(x.data(), size), Pairs(y.data(), size))};
  }
};

/// The name of the number that estimates Ivar_basis; empty without one.
std::string estimate_name(const AssessmentForm& form) {
  for (const NumberPlace& place : form.places())
    if (place.info.finding == NumberFinding::regression)
      return place.info.name;
  return {};
}

/// The experiments of one kind.
class KindCounts {
 public:
  KindCounts(const Study& study, const AssessmentForm& form, std::size_t method, ExperimentKind kind)
      : study_(study),
        method_(method),
        estimate_(estimate_name(form)),
        numbers_(summarised_numbers(form)),
        values_(numbers_.size()) {
    found_.kind = kind;
    found_.confusion = ConfusionMatrix(study.cv_count());
    for (const NonlinearCause cause : kNonlinearCauses)
      without_cause_.push_back({cause});
  }

  void add(const ExperimentRecord& record) {
    if (record.draw.kind != found_.kind)
      return;
    found_.add(record);
    const AssessmentRecord& said = record.assessments[method_];
    if (!said.answered())
      return;
    ++verdicts_;
    flagged_ += said.flagged ? 1 : 0;
    const Judgement judgement = judge(study_, record, said);
    if (judgement.predicted_cv != Correctness::not_judged)
      found_.confusion.add(record.draw.true_cv(), said.predicted_cv);
    judged_ += judgement.source() == Correctness::not_judged ? 0 : 1;
    recognised_ += judgement.source() == Correctness::right ? 1 : 0;
    if (in_source_population(study_, said))
      for (std::size_t n = 0; n < numbers_.size(); ++n)
        values_[n].push_back(said.number(numbers_[n]->name));
    if (estimate_.empty())
      return;
    pairs_.add(record, said.values(estimate_));
    causes_known_ = causes_known_ || some_known(record.conditions);
    for (PairsWithoutCause& pairs : without_cause_)
      pairs.add(record, said.values(estimate_));
  }

  KindFindings result() const {
    const double confidence = study_.aggregate.confidence;
    KindFindings result = found_;
    result.finish(confidence);
    result.flagged = rate(flagged_, verdicts_, confidence);
    result.located = result.confusion.accuracy(confidence);
    result.source_recognised = rate(recognised_, judged_, confidence);
    for (const std::vector<double>& of_number : values_)
      result.summaries.push_back(summarise(of_number, confidence));
    if (!estimate_.empty())
      fit_regressions(result);
    return result;
  }

 private:
  void fit_regressions(KindFindings& result) const {
    const auto ny = static_cast<std::size_t>(study_.cv_count());
    // Every fit has its own bootstrap stream, so that it does not depend on which other fits are made.
    const std::uint64_t first = static_cast<std::uint64_t>(result.kind) * (ny + 1);
    result.regression = pairs_.fit(study_, first);
    for (std::size_t cv = 0; cv < ny; ++cv)
      result.regression_of_cv.push_back(pairs_.fit_of(cv, ny, study_, first + 1 + cv));
    if (causes_known_)
      for (const PairsWithoutCause& pairs : without_cause_)
        result.without_cause.push_back(pairs.result());
  }

  const Study& study_;
  std::size_t method_;
  std::string estimate_;
  std::vector<const AssessmentNumberInfo*> numbers_;
  KindFindings found_;
  std::int64_t verdicts_ = 0, flagged_ = 0, judged_ = 0, recognised_ = 0;
  std::vector<std::vector<double>> values_;
  IvarPairs pairs_;
  bool causes_known_ = false;
  std::vector<PairsWithoutCause> without_cause_;
};

struct AllKindCounts {
  std::vector<KindCounts> kinds;

  void add(const ExperimentRecord& record) {
    for (KindCounts& kind : kinds)
      kind.add(record);
  }
  std::vector<KindFindings> result() const {
    std::vector<KindFindings> findings;
    for (const KindCounts& kind : kinds)
      findings.push_back(kind.result());
    return findings;
  }
};

/// I_MPM of the experiments with both faults, by bin.
class DominanceCounts {
 public:
  DominanceCounts(const Study& study, std::size_t method) : study_(study), method_(method) {}

  void add(const ExperimentRecord& record) {
    const AssessmentRecord& said = record.assessments[method_];
    if (record.draw.kind != ExperimentKind::mpm_ud || !in_source_population(study_, said))
      return;
    const double dominance = said.number("dominance_mpm");
    for (std::size_t b = 0; b < i_mpm_.size(); ++b)
      if (is_in(b, dominance))
        i_mpm_[b].push_back(said.number("i_mpm"));
  }

  std::vector<DominanceBin> result() const {
    std::vector<DominanceBin> bins;
    if (study_.experiments.mpm_ud == 0)
      return bins;
    const double confidence = study_.aggregate.confidence;
    for (std::size_t b = 0; b < i_mpm_.size(); ++b) {
      const auto above = std::count_if(i_mpm_[b].begin(), i_mpm_[b].end(),
                                       [&](double i_mpm) { return i_mpm > mpm_threshold(study_); });
      bins.push_back({kDominanceEdges[b], kDominanceEdges[b + 1], summarise(i_mpm_[b], confidence),
                      rate(above, std::ssize(i_mpm_[b]), confidence)});
    }
    return bins;
  }

 private:
  bool is_in(std::size_t bin, double dominance) const {
    const bool last = bin + 1 == i_mpm_.size();
    const double upper = kDominanceEdges[bin + 1];
    return dominance >= kDominanceEdges[bin] && (dominance < upper || (last && dominance <= upper));
  }

  const Study& study_;
  std::size_t method_;
  std::array<std::vector<double>, kDominanceEdges.size() - 1> i_mpm_;
};

/// I_MPM of the experiments with one fault, by its source.
class SourceScores {
 public:
  SourceScores(const Study& study, std::size_t method) : study_(study), method_(method) {}

  void add(const ExperimentRecord& record) {
    const AssessmentRecord& said = record.assessments[method_];
    if (!in_source_population(study_, said))
      return;
    if (record.draw.kind == ExperimentKind::mpm)
      mpm_.push_back(said.number("i_mpm"));
    else if (record.draw.kind == ExperimentKind::ud)
      ud_.push_back(said.number("i_mpm"));
  }

  SourceCurve result() const {
    const AggregateOptions& options = study_.aggregate;
    SourceCurve source{roc_curve(mpm_, ud_)};
    if (!source.curve.defined())
      return source;
    source.area =
        area_interval(source.curve.area, source.curve.positives, source.curve.negatives, options.confidence);
    // The regressions use the first bootstrap streams, so this interval uses the last one.
    RandomStream stream(study_.seed, std::numeric_limits<std::uint64_t>::max(), StreamId::bootstrap);
    source.best_threshold =
        best_threshold_interval(mpm_, ud_, stream, {options.bootstrap_replications, options.confidence});
    source.at_study = roc_point(mpm_, ud_, mpm_threshold(study_));
    return source;
  }

 private:
  const Study& study_;
  std::size_t method_;
  std::vector<double> mpm_, ud_;
};

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

/// Returns the row of R^2 over the loops without a cause for which one linear S0 fails.
Finding without_cause_row(const KindFindings::WithoutCause& without, Finding like,
                          const std::string& prefix) {
  const bool any = without.cause == NonlinearCause::none;
  const std::string loops =
      any ? "loops with none of the causes" : fmt::format("loops without: {}", title_of(without.cause));
  like.name = fmt::format("{}r_squared_without_{}", prefix, any ? "causes" : to_string(without.cause));
  like.label = fmt::format("R\xC2\xB2 of Ivar_{{basis}} on Ivar, {}", loops);
  like.meaning = fmt::format("R^2 of Ivar_basis on Ivar, {}", loops);
  like.prominence = Prominence::detail;
  like.has_interval = false;
  return like.with(without.fit.r_squared, {kNaN, kNaN}, without.fit.pairs);
}

/// A plot label as plain text: "I_{MPM}" is "I_MPM".
std::string without_marks(std::string label) {
  std::erase_if(label, [](char c) { return c == '{' || c == '}'; });
  return label;
}

}  // namespace

Collector<std::vector<KindFindings>> kind_collector(const Study& study, const AssessmentForm& form,
                                                    std::size_t method) {
  AllKindCounts counts;
  for (const ExperimentKind kind : {ExperimentKind::mpm, ExperimentKind::ud, ExperimentKind::mpm_ud})
    if (study.experiments.of(kind) > 0)
      counts.kinds.emplace_back(study, form, method, kind);
  return collector_of(std::move(counts));
}

Finding unstable_row(const Endings& endings, Finding like) {
  like.label = "loop unstable";
  like.meaning = "share of loops that are unstable with the active set of the basis case";
  return like.with(endings.unstable);
}

std::vector<const AssessmentNumberInfo*> summarised_numbers(const AssessmentForm& form) {
  std::vector<const AssessmentNumberInfo*> numbers;
  for (const NumberPlace& place : form.places())
    if (place.info.finding == NumberFinding::summary)
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
          ? like("impactful", "with impact", "share of the feasible experiments that have an impact")
                .with(kind.flagged)
          : like("flagged", "flagged", "share of the experiments with a verdict that are flagged")
                .with(kind.flagged)};
  if (kind.unstable.total > 0)
    rows.push_back(unstable_row(kind, like("unstable", "", "", Prominence::detail)));
  const Finding regression = like("", "", "");
  if (!kind.regression_of_cv.empty()) {
    append_regression(kind.regression, regression, of, "", rows);
    rows[rows.size() - 3].prominence = Prominence::headline;
  }
  for (const KindFindings::WithoutCause& without : kind.without_cause)
    rows.push_back(without_cause_row(without, regression, of));
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
    Finding number = like("", numbers[n]->heading.c_str(), without_marks(numbers[n]->heading).c_str());
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

Collector<std::vector<DominanceBin>> dominance_collector(const Study& study, std::size_t method) {
  return collector_of(DominanceCounts(study, method));
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
        fmt::format("share of experiments at dominance {:g} to {:g} with I_MPM above its threshold",
                    bin.lower, bin.upper);
    above.prominence = Prominence::detail;
    rows.push_back(above.with(bin.above_threshold));
  }
  return rows;
}

Collector<SourceCurve> source_curve_collector(const Study& study, std::size_t method) {
  return collector_of(SourceScores(study, method));
}

std::vector<Finding> rows_of(const SourceCurve& source) {
  const std::int64_t experiments =
      source.curve.defined() ? source.curve.positives + source.curve.negatives : 0;
  const Finding area{.name = "i_mpm_auc",
                     .label = "area under the ROC curve of I_{MPM}",
                     .meaning = "area under the ROC curve of I_MPM, mismatches against disturbances",
                     .group = FindingGroup::study,
                     .prominence = Prominence::headline};
  const Finding threshold{.name = "i_mpm_best_threshold",
                          .label = "threshold of I_{MPM} with the largest J",
                          .meaning = "threshold of I_MPM with the largest Youden's J, chosen on these data",
                          .group = FindingGroup::study,
                          .prominence = Prominence::detail};
  return {area.with(source.curve.area, source.area, experiments),
          threshold.with(source.curve.defined() ? source.curve.best.threshold : kNaN, source.best_threshold,
                         experiments)};
}

Rate over_kinds(const std::vector<KindFindings>& kinds, Rate KindFindings::*member, double confidence) {
  std::int64_t hits = 0, total = 0;
  for (const KindFindings& kind : kinds) {
    hits += (kind.*member).hits;
    total += (kind.*member).total;
  }
  return rate(hits, total, confidence);
}

}  // namespace mpm
