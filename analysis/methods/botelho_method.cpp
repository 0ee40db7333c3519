#include <algorithm>
#include <cmath>

#include "analysis/indicators/diagnosis.hpp"
#include "analysis/methods/methods.hpp"
#include "analysis/sensitivity/nominal_estimator.hpp"

namespace mpm {
namespace {

class Botelho final : public AssessmentMethod {
 public:
  explicit Botelho(const AssessmentContext& context)
      : options_(context.study.diagnosis),
        y_basis_(context.basis.trajectory.y),
        estimator_(context.study, context.basis.point, context.basis.sensitivity, context.factory),
        chain_(context.study) {}

  Assessment assess(const AssessedLoop& loop) override {
    Trajectory record;
    record.samples_done = loop.samples();
    record.y = loop.y;
    record.u = loop.u;
    record.u_target = loop.u_target;
    record.d = loop.d;
    const NominalOutputs nominal = estimator_.estimate(record);
    const Diagnosis diagnosis = chain_.diagnose(loop.y, nominal, y_basis_);
    Assessment assessment;
    assessment.flagged = diagnosis.impactful;
    assessment.score = 0.0;
    for (Eigen::Index cv = 0; cv < diagnosis.ivar.size(); ++cv) {
      assessment.score = std::max(assessment.score, distance(diagnosis.ivar(cv)));
      const bool flagged = options_.has_impact(diagnosis.ivar_diag(cv));
      const bool predicted = cv == diagnosis.predicted_cv;  // diagnose() has its indicator already
      const MpmIndicator indicator = predicted ? diagnosis.indicator
                                     : flagged ? chain_.indicator_of(cv, loop.y, nominal)
                                               : MpmIndicator{};
      assessment.cvs.push_back({flagged, distance(diagnosis.ivar_diag(cv)),
                                predicted || flagged ? chain_.source_of(indicator) : ExperimentKind::none});
      assessment.numbers.push_back({"ivar", diagnosis.ivar(cv), cv});
      assessment.numbers.push_back({"ivar_diag", diagnosis.ivar_diag(cv), cv});
      assessment.numbers.push_back({"i_mpm", indicator.i_mpm, cv});
    }
    return assessment;
  }

 private:
  /// Of a variance index from 1, as the study measures it to locate a CV.
  double distance(double ivar) const { return distance_from_one(ivar, options_.location_distance); }

  const DiagnosisOptions& options_;
  const Eigen::MatrixXd& y_basis_;
  NominalEstimator estimator_;
  DiagnosisChain chain_;
};

}  // namespace

AssessmentMethodInfo botelho_method() {
  return {.name = "botelho",
          .title = "Botelho (2015)",
          .verdict = "a modelling error has an impact: some Ivar lies outside the band of impact",
          .requirements = {},
          .locates_cvs = true,
          .names_channels = false,
          .tells_sources = true,
          .numbers = {{"ivar", NumberScope::cv, "var y / var y0 (3.24, 6.7)"},
                      {"ivar_diag", NumberScope::cv, "var y / var y0_diag (4.14, 6.8)"},
                      {"i_mpm", NumberScope::cv,
                       "indicator of a mismatch (6.15), of CVs that are flagged or the worst"}},
          .make = [](const AssessmentContext& context) { return std::make_unique<Botelho>(context); }};
}

}  // namespace mpm
