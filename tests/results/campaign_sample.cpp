#include "tests/results/campaign_sample.hpp"

#include <cmath>
#include <string>

#include "scenarios/study_file.hpp"
#include "scenarios/study_library.hpp"
#include "tests/results/made_up_campaign.hpp"

using namespace mpm;

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
  return parse_study(text, "chapter6");
}

}  // namespace

Campaign campaign_sample() {
  Campaign campaign;
  campaign.study = study_with_setpoint();
  campaign.study.seed = 12345678901234567890ULL;  // not the one in the file, and above the signed range
  const QpSolverFactory factory = qp_solver_factory("active-set");
  campaign.basis = run_basis_case(campaign.study, factory);
  ExperimentRunner runner(campaign.study, campaign.basis, factory);
  for (std::int64_t i = 0; i < 8; ++i)
    campaign.records.push_back(runner.run(i, i < 2 ? StorePolicy::all : StorePolicy::none));
  campaign.records[2].diagnosis.ivar(0) = std::nan("");
  campaign.records[2].diagnosis.ivar_diag(0) = INFINITY;
  campaign.records[3].status = ExperimentStatus::infeasible;
  campaign.records[3].diagnosis = {};
  campaign.records[3].perturbed = {};
  campaign.records[4].status = ExperimentStatus::failed;
  campaign.records[4].diagnosis = {};
  campaign.records[4].perturbed = {};
  campaign.records[4].message = "ended by signal 9: \xc3\xbc";
  campaign.info = {"0.1.0", "abcdef", "2026-01-01T00:00:00Z", "mpmbench run chapter6", "active-set", 1.5, 2,
                   0.25,    0.5};
  campaign.audit = {{2, 7, {true, 1e-11, 2e-9}, {true, 3e-7, 4e-9}, 5e-11},
                    {5, 301, {true, 0.0, 0.0}, {false, std::nan(""), std::nan("")}, 6e-11}};
  campaign.comparison = mpm::testing::made_up_comparison(campaign.study, campaign.records);
  campaign.comparison_info = {"0.1.0", "abcdef", "mpmbench compare a.h5"};
  return campaign;
}
