#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "analysis/indicators/acf_comparison.hpp"
#include "analysis/indicators/diagnosis.hpp"
#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/literature/designed_output.hpp"
#include "analysis/statistics/variance.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

struct Badwe2010Options {
  int smallest_order = 3, largest_order = 7;  ///< orders of the output-error models (3.3.2)
  DesignedOrderCriterion criterion = DesignedOrderCriterion::record_fit;
  int max_iterations = 20;  ///< iterations of the search for each model

  bool operator==(const Badwe2010Options&) const = default;
};

OptionKeys keys(Badwe2010Options& options) {
  return {key::whole("smallest_order", options.smallest_order, 1, 100,
                     "smallest order of the output-error models (3.3.2)"),
          key::whole_from("largest_order", options.largest_order, options.smallest_order, 100,
                          "largest order n (3.3.2). A record is assessed only if it has more samples than "
                          "the 2n + 1 coefficients of each CV with a setpoint")
              .allow("`smallest_order` to 100"),
          key::choice(
              "criterion", options.criterion, {"record-fit", "validation-fit", "bic"},
              "how the order is chosen. `\"record-fit\"`: by the largest %Fit (3.32) over the record, which "
              "is the \"best model fit\" that the thesis reports. `\"validation-fit\"`: by the largest %Fit "
              "over the last 30 % of models of the first 70 %. `\"bic\"`: by the smallest BIC"),
          key::whole("max_iterations", options.max_iterations, 1, 100'000,
                     "iterations of the search for each model; 20 is the default of `oe` in Matlab, with "
                     "which the thesis worked")};
}

DesignedOutputOptions options_of(const Badwe2010Options& study) {
  DesignedOutputOptions options;
  options.orders.clear();
  for (int order = study.smallest_order; order <= study.largest_order; ++order)
    options.orders.push_back(order);
  options.criterion = study.criterion;
  options.max_iterations = study.max_iterations;
  options.validate();
  return options;
}

/// Why models of the largest order cannot be identified in the record of `cvs` CVs; none if they can.
std::optional<std::string> too_short(Eigen::Index samples, Eigen::Index cvs,
                                     const DesignedOutputOptions& options) {
  const Eigen::Index largest = options.orders.back();
  const Eigen::Index coefficients = cvs * (2 * largest + 1);
  const double share =
      options.criterion == DesignedOrderCriterion::validation_fit ? 1.0 - options.validation_share : 1.0;
  const double estimated = share * static_cast<double>(samples);
  if (estimated >= static_cast<double>(coefficients + 1))
    return std::nullopt;
  return fmt::format(
      "its models of order {} have {} coefficients for {:g} samples: a smaller [assessment.badwe2010] "
      "largest_order may do",
      largest, coefficients, estimated);
}

class Badwe2010 final : public AssessmentMethod {
 public:
  explicit Badwe2010(const AssessmentContext& context)
      : diagnosis_(context.study.diagnosis),
        y_basis_(recorded_basis(context)),
        options_(options_of(context.study.assessment.of<Badwe2010Options>())) {}

  Assessment assess(const AssessedLoop& loop) override {
    const std::vector<Eigen::Index> cvs = loop.setpoint_cvs();
    if (const auto reason = too_short(loop.samples(), static_cast<Eigen::Index>(cvs.size()), options_))
      return Assessment::not_applicable(*reason);
    const Eigen::MatrixXd y = loop.y(cvs, Eigen::all);
    const Eigen::MatrixXd y_set = loop.y_set(cvs, Eigen::all);
    const DesignedOutput designed = designed_output(y, loop.y_sim(cvs, Eigen::all), y_set, options_);
    Assessment assessment;
    assessment.cvs.resize(static_cast<std::size_t>(loop.y.rows()));
    for (Eigen::Index i = 0; i < y.rows(); ++i) {
      const Eigen::Index cv = cvs[static_cast<std::size_t>(i)];
      add_models(designed, i, cv, assessment);
      if (designed.has(i))
        judge(y.row(i).transpose(), designed.y0.row(i).transpose(), y_set.row(i).transpose(), cv, assessment);
    }
    if (std::isnan(assessment.score))
      return Assessment::failed(
          "no output-error model describes the loop: the controller inputs stand still");
    return assessment;
  }

 private:
  static void add_models(const DesignedOutput& designed, Eigen::Index i, Eigen::Index cv,
                         Assessment& assessment) {
    const ClosedLoopModel& S_d = designed.sensitivity[static_cast<std::size_t>(i)];
    const ClosedLoopModel& mismatch = designed.mismatch[static_cast<std::size_t>(i)];
    assessment.numbers.push_back({"fit_sd", S_d.fit, cv});
    assessment.numbers.push_back({"fit_dgk", mismatch.fit, cv});
    assessment.numbers.push_back({"order_sd", static_cast<double>(S_d.order), cv});
    assessment.numbers.push_back({"order_dgk", static_cast<double>(mismatch.order), cv});
  }

  /// Adds the verdict and the numbers that follow from the designed output of one CV.
  void judge(const Eigen::VectorXd& y, const Eigen::VectorXd& y0, const Eigen::VectorXd& y_set,
             Eigen::Index cv, Assessment& assessment) const {
    const double ivar = variance_index(y, y0, y_set);
    const AcfComparison acf = compare_autocorrelations(y, y0, y0, y_set);
    assessment.numbers.push_back({"ivar", ivar, cv});
    assessment.numbers.push_back({"decay_lag_ratio", acf.decay_lag_ratio, cv});
    assessment.numbers.push_back({"oscillates", acf.oscillates_by_error() ? 1.0 : 0.0, cv});
    if (y_basis_.cols() == y.size())
      assessment.numbers.push_back({"sqr", (y_basis_.row(cv).transpose() - y0).cwiseAbs().sum(), cv});
    if (std::isnan(ivar))
      return;  // neither y nor y0 leaves the setpoint
    CvAssessment& verdict = assessment.cvs[static_cast<std::size_t>(cv)];
    verdict.flagged = diagnosis_.has_impact(ivar);
    verdict.score = distance_from_one(ivar, diagnosis_.location_distance);
    assessment.flagged = assessment.flagged || *verdict.flagged;
    assessment.score =
        std::isnan(assessment.score) ? verdict.score : std::max(assessment.score, verdict.score);
  }

  const DiagnosisOptions& diagnosis_;
  Eigen::MatrixXd y_basis_;
  DesignedOutputOptions options_;
};

}  // namespace

AssessmentMethodInfo badwe2010_method() {
  return {
      {.name = "badwe2010",
       .title = "Badwe et al. (2010)",
       .verdict = "the mismatch has an impact: Ivar of some CV, relative to its designed output, lies "
                  "outside the band of impact",
       .requirements = {.setpoints = true, .moving_setpoints = true},
       .locates_cvs = true,
       .names_channels = false,
       .tells_sources = false,
       .numbers = {{"ivar", NumberScope::cv,
                    "var(y - y_set)/var(y0 - y_set) (3.24), y0 the designed output (3.7)"},
                   {"sqr", NumberScope::cv, "sum over the samples of |y_basis - y0| (3.31)"},
                   {"fit_sd", NumberScope::cv, "%Fit (3.32) of the output-error model of S_d (3.3)"},
                   {"fit_dgk", NumberScope::cv,
                    "%Fit (3.32) of the output-error model of Delta G K (3.5); none for y = y_hat"},
                   {"order_sd", NumberScope::cv, "order of the model of S_d"},
                   {"order_dgk", NumberScope::cv, "order of the model of Delta G K"},
                   {"decay_lag_ratio", NumberScope::cv,
                    "decay lag of the autocorrelation of y - y_set over that of y0 - y_set"},
                   {"oscillates", NumberScope::cv, "1 when y - y_set oscillates and y0 - y_set does not"}}},
      {},
      [](const AssessmentContext& context) { return std::make_unique<Badwe2010>(context); },
      option_table<Badwe2010Options>(keys, "options of the method of Badwe et al. (2010)")};
}

}  // namespace mpm
