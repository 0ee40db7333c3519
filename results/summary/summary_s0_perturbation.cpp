#include <string>

#include <fmt/format.h>

#include "results/summary/summary_sections.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

constexpr std::size_t kCvWidth = 32;

/// Fits and changes of the CVs at a soft limit when S0 is modified.
void add_changes(SummaryLines& text, const Study& study, const SummaryContent& parts) {
  if (parts.s0_fits.empty())
    return;
  const S0PerturbationOptions& options = study.s0_perturbation;
  constexpr auto kRow = "{:<{}}  {:>8}  {:>6}  {:>6}  {:>8}  {:>8}  {:>8}  {:>8}";
  text.line("");
  text.line(kRow,
            fmt::format("S0 modified, {:g} to {:g} times", options.tolerance_lower, options.tolerance_upper),
            kCvWidth, "tau", "xi", "count", "by tau", "in band", "by xi", "in band");
  for (const DiagonalFit& fit : parts.s0_fits) {
    S0Curve none{fit.cv, 0, {}, {}, {}, {}};
    none.time_constant_change.within_band = none.damping_change.within_band = rate(0, 0);
    const S0Curve* curve = &none;
    for (const S0Curve& known : parts.s0_curves)
      if (known.cv == fit.cv)
        curve = &known;
    text.line(kRow, cv_name(study, fit.cv), kCvWidth, digits_text(fit.fit.model.time_constant),
              digits_text(fit.fit.model.damping), curve->experiments,
              digits_text(curve->time_constant_change.largest),
              number_text(curve->time_constant_change.within_band.value, true),
              digits_text(curve->damping_change.largest),
              number_text(curve->damping_change.within_band.value, true));
  }
  text.line("(tau, xi: fit of (6.24) to T0; by tau, by xi: largest relative change of Ivar_diag of the");
  text.line("affected CV when it is multiplied; in band: experiments whose change keeps to {:g} to {:g})",
            study.diagnosis.impact_lower, study.diagnosis.impact_upper);
}

/// The fits with MVs fixed, and their multipliers.
void add_structures(SummaryLines& text, const Study& study, const std::vector<StructureFit>& fits) {
  if (fits.empty())
    return;
  std::string fixed;
  for (const Eigen::Index mv : study.s0_perturbation.fixed_mvs)
    fixed += (fixed.empty() ? "" : ", ") + mv_name(study, mv);
  text.line("");
  text.line("{:<{}}  {:>8}  {:>6}  {:>10}  {:>10}", "S0 with " + fixed + " fixed", kCvWidth, "tau", "xi",
            "tau times", "xi times");
  for (const StructureFit& fit : fits)
    text.line("{:<{}}  {:>8}  {:>6}  {:>10}  {:>10}", cv_name(study, fit.cv), kCvWidth,
              digits_text(fit.fixed.model.time_constant), digits_text(fit.fixed.model.damping),
              digits_text(fit.time_constant_multiplier), digits_text(fit.damping_multiplier));
}

}  // namespace

void add_s0_perturbation(SummaryLines& text, const Study& study, const SummaryContent& parts) {
  add_changes(text, study, parts);
  add_structures(text, study, parts.structure_fits);
}

}  // namespace mpm
