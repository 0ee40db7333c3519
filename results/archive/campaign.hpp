#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/basis/basis_case.hpp"
#include "analysis/experiment/experiment.hpp"
#include "analysis/findings/comparison.hpp"
#include "scenarios/audit.hpp"
#include "scenarios/study.hpp"

namespace mpm {

/// How, when and by which program a campaign was run. Nothing in it changes a result, but for the solver.
struct CampaignInfo {
  std::string mpmbench_version;
  std::string git_sha;
  std::string created;  ///< ISO 8601, UTC
  std::string command;
  std::string solver;
  double seconds = 0.0;        ///< wall-clock time
  int jobs = 1;                ///< experiments run at once
  double audit_share = 0.0;    ///< share of the steps that were audited
  double audit_seconds = 0.0;  ///< processor time of the audit
};

/// By which program and command a comparison of methods was made.
struct ComparisonInfo {
  std::string mpmbench_version;
  std::string git_sha;
  std::string command;
};

/// Everything that a run of a study leaves behind.
///
/// `study.seed` is the seed that was used; it may differ from the one in `study.source`. `records` are the
/// experiments that were run, in the order of their index.
struct Campaign {
  Study study;
  CampaignInfo info;
  BasisCase basis;
  std::vector<ExperimentRecord> records;
  std::vector<AuditedStep> audit;             ///< in the order of experiment and step
  std::optional<Comparison> comparison = {};  ///< of methods of assessment; none until one was made
  ComparisonInfo comparison_info = {};
};

}  // namespace mpm
