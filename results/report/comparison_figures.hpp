#pragma once

#include <vector>

#include "analysis/findings/study_findings.hpp"
#include "results/plot/figure.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// Draws one panel per rate, except `answered`, of which a table already says everything.
Figure comparison_rates_figure(const Study& study, const std::vector<MethodFindings>& methods);

/// Tells whether any method has a ROC curve for this truth.
bool has_curves(const std::vector<MethodFindings>& methods, FlagTruth truth);

/// Draws the ROC curves of the methods that have one. There must be at least one.
Figure comparison_roc_figure(const std::vector<MethodFindings>& methods, FlagTruth truth);

}  // namespace mpm
