#include "tests/results/campaign_sample.hpp"

#include <cmath>
#include <string>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "scenarios/loop/calibration.hpp"
#include "scenarios/loop/draw.hpp"
#include "solvers/qp_solver_factory.hpp"
#include "tests/results/made_up_campaign.hpp"

using namespace mpm;
using namespace mpm::testing;

namespace {

std::string after(std::string text, const std::string& line, const std::string& inserted) {
  return text.insert(text.find(line) + line.size(), inserted);
}

/// The chapter 6 study with a setpoint, which is stepped, beside the range of y1: an archive has records of
/// setpoints only then.
Study study_with_setpoint() {
  std::string text = after(find_study("chapter6").source, "[controller.cv.y1]\n", "setpoint_weight = 10.0\n");
  for (const char* step : {"sample = 30\nlevel = 0.2", "sample = 200\nlevel = 0.05"})
    text = after(text, "level = 0.4\n", std::string("\n[[simulation.step]]\ncv = \"y1\"\n") + step + "\n");
  return parse_study(text + "\n[calibration]\nhealthy = 3\nud = 2\n", "chapter6");
}

/// Scores that count up; the first loop has none of the first method.
Calibration made_up_calibration(const Study& study) {
  const Study loops = calibration_study(study);
  Calibration calibration{loops.seed, {}};
  double score = 0.0;
  for (std::int64_t index = 0; index < loops.experiment_count(); ++index) {
    calibration.loops.push_back({draw_experiment(loops, index).kind, {}});
    for (std::size_t method = 0; method < study.methods.size(); ++method)
      calibration.loops.back().scores.push_back(score += 0.25);
  }
  calibration.loops[0].scores[0] = std::nan("");
  return calibration;
}

/// An experiment that is left out.
void end_as(ExperimentRecord& record, ExperimentStatus status, const std::string& message) {
  record.status = status;
  record.message = message;
  record.ivar_basis = {};
  record.perturbed = {};
  record.assessments = {unasked(record.assessments.front().form)};
}

void make_awkward(std::vector<ExperimentRecord>& records) {
  records[2].assessments.front().set_number("ivar", std::nan(""));
  records[2].assessments.front().set_number("ivar_diag", INFINITY);
  end_as(records[3], ExperimentStatus::infeasible, "");
  end_as(records[4], ExperimentStatus::failed, "ended by signal 9: \xc3\xbc");
}

/// Of the methods beside the chain (the first loops of SSE are flagged or not), and a processor time of the
/// chain that is the same in every run.
void add_made_up_answers(Campaign& campaign) {
  const AssessmentForms forms = forms_of(campaign);
  for (ExperimentRecord& record : campaign.records) {
    const bool ran = record.status == ExperimentStatus::ok;
    // Numbers of its own for each method, so that those of the others stay when one is added behind them.
    std::uint64_t which = 31 * static_cast<std::uint64_t>(record.draw.index);
    if (ran)
      record.assessments.front().milliseconds = 125.0;
    for (std::size_t method = 1; method < forms.size(); ++method)
      record.assessments.push_back(ran ? made_up_answer(campaign.study, forms[method], ++which)
                                       : unasked(forms[method]));
  }
}

}  // namespace

Campaign campaign_sample() {
  Campaign campaign;
  campaign.study = study_with_setpoint();
  campaign.study.seed = 12345678901234567890ULL;  // not the one in the file, and above the signed range
  const QpSolverFactory factory = qp_solver_factory("active-set");
  campaign.basis = run_basis_case(campaign.study, factory);
  campaign.methods = made_up_methods(campaign.study);
  campaign.study.methods = method_names(campaign);
  campaign.calibration = made_up_calibration(campaign.study);
  ExperimentRunner runner(campaign.study, campaign.basis, {"botelho"}, factory);
  for (std::int64_t i = 0; i < 8; ++i)
    campaign.records.push_back(runner.run(i, i < 3 ? StorePolicy::truth : StorePolicy::none));
  make_awkward(campaign.records);
  add_made_up_answers(campaign);
  campaign.info = {
      "0.1.0", "abcdef", "2026-01-01T00:00:00Z", "mpmbench run chapter6", "", "active-set", 1.5, 2,
      0.25,    0.5};
  campaign.audit = {{2, 7, {true, 1e-11, 2e-9}, {true, 3e-7, 4e-9}, 5e-11},
                    {5, 301, {true, 0.0, 0.0}, {false, std::nan(""), std::nan("")}, 6e-11}};
  return campaign;
}
