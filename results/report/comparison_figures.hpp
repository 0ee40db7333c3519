#pragma once

#include <vector>

#include "analysis/findings/study_findings.hpp"
#include "results/plot/figure.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// A panel a rate; `answered` says nothing that a table does not.
Figure comparison_rates_figure(const Study& study, const std::vector<MethodFindings>& methods);

/// Does some method have a ROC curve for this truth?
bool has_curves(const std::vector<MethodFindings>& methods, FlagTruth truth);

/// The ROC curves of the methods that have one, which must be some.
Figure comparison_roc_figure(const std::vector<MethodFindings>& methods, FlagTruth truth);

}  // namespace mpm
