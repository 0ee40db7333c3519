#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "analysis/indicators/diagnosis.hpp"
#include "analysis/methods/assessment_method.hpp"
#include "analysis/methods/thesis/chain_numbers.hpp"
#include "analysis/sensitivity/nominal_estimator.hpp"

namespace mpm {
namespace {

/// Why the method does not apply; none if it does. A study that does not check Ivar of the basis case may
/// have a basis case whose variance is mostly noise. S0 filters this noise out of y0, so Ivar of a perfect
/// model is far from 1.
std::optional<std::string> why_noise_outweighs(const AssessmentContext& context) {
  const DiagnosisOptions& options = context.study.diagnosis;
  if (options.self_check == SelfCheck::ivar)
    return std::nullopt;
  const Eigen::VectorXd& ivar = context.basis.diagnosis.ivar;
  for (Eigen::Index cv = 0; cv < ivar.size(); ++cv)
    if (!(ivar(cv) >= options.self_check_lower && ivar(cv) <= options.self_check_upper))
      return fmt::format(
          "it needs excitation that outweighs the noise: Ivar of the basis case is {:.3g} for {}", ivar(cv),
          context.study.plant.cvs[static_cast<std::size_t>(cv)].name);
  return std::nullopt;
}

class Botelho final : public AssessmentMethod {
 public:
  explicit Botelho(const AssessmentContext& context)
      : study_(context.study),
        options_(context.study.diagnosis),
        estimator_(context.study, context.basis.point, context.basis.sensitivity, context.factory),
        chain_(context.study),
        without_excitation_(why_noise_outweighs(context)) {}

  Assessment assess(const AssessedLoop& loop) override {
    if (without_excitation_)
      return Assessment::not_applicable(*without_excitation_);
    const AssessedLoop& whole = loop.from_start();
    Trajectory record;
    record.y = whole.y;
    record.u = whole.u;
    record.u_target = whole.u_target;
    record.d = whole.d;
    const NominalOutputs nominal = estimator_.estimate(record, whole.y_sim);
    if (!loop.whole)
      return judged(loop.y, nominal, chain_);
    DiagnosisChain chain(study_, loop.first, loop.samples());
    return judged(loop.y, {loop.y_sim, loop.in_window(nominal.y0), loop.in_window(nominal.y0_diag)}, chain);
  }

 private:
  Assessment judged(const Eigen::MatrixXd& y, const NominalOutputs& nominal, DiagnosisChain& chain) const {
    const Diagnosis diagnosis = chain.diagnose(y, nominal);
    Assessment assessment;
    assessment.flagged = diagnosis.impactful;
    for (Eigen::Index cv = 0; cv < diagnosis.ivar.size(); ++cv) {
      assessment.score = std::fmax(assessment.score, distance(diagnosis.ivar(cv)));
      const bool flagged = options_.has_impact(diagnosis.ivar_diag(cv));
      const FaultSource source = cv == diagnosis.predicted_cv ? diagnosis.predicted_source
                                 : flagged ? chain.source_of(chain.indicator_of(cv, y, nominal))
                                           : FaultSource::none;
      const double away = distance(diagnosis.ivar_diag(cv));
      // A CV that stands still gets no verdict.
      assessment.cvs.push_back({std::isnan(away) ? std::nullopt : std::optional(flagged), away, source});
    }
    assessment.numbers = chain_numbers(diagnosis);
    return assessment;
  }

  /// The distance of a variance index from 1, as the study measures it to locate a CV.
  double distance(double ivar) const { return distance_from_one(ivar, options_.location_distance); }

  const Study& study_;
  const DiagnosisOptions& options_;
  NominalEstimator estimator_;
  DiagnosisChain chain_;
  std::optional<std::string> without_excitation_;  ///< why the method does not apply to any loop of the study
};

}  // namespace

AssessmentMethodInfo botelho_method() {
  AssessmentMethodInfo info;
  info.name = "botelho";
  info.title = "Botelho (2015)";
  info.verdict = "a modelling error has an impact: some Ivar lies outside the band of impact";
  info.requirements.nominal_loop = true;
  info.requirements.analyses_as_shown = true;
  info.locates_cvs = true;
  info.tells_sources = true;
  info.numbers = chain_number_infos();
  info.scenario_numbers = scenario_number_infos;
  info.make = [](const AssessmentContext& context) { return std::make_unique<Botelho>(context); };
  return info;
}

}  // namespace mpm
