#include <string>
#include <utility>

#include <catch2/catch.hpp>

#include "analysis/basis/basis_runs.hpp"
#include "analysis/methods/literature/badwe2009.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/ours/learnt_context.hpp"
#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "scenarios/loop/draw.hpp"
#include "solvers/qp_solver.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace mpm {
namespace {

/// The loops of a study, assessed by the method.
class Bench {
 public:
  explicit Bench(Study study)
      : study_(std::move(study)),
        basis_(run_basis_case(study_, testing::kFactory)),
        context_(assessment_context(study_, basis_, testing::kFactory)),
        assessor_(assessment_method("badwe2009"), context_) {}

  Assessment basis() { return assessor_.assess(loop_of(basis_.trajectory)); }
  Assessment scenario(std::int64_t index) {
    return assessor_.assess(
        loop_of(simulate_experiment(study_, draw_experiment(study_, index), testing::kFactory)));
  }
  AssessedLoop loop_of(const Trajectory& loop) const { return assessed_loop(study_, basis_.point, loop); }
  Assessment assess(const AssessedLoop& loop) { return assessor_.assess(loop); }
  const Trajectory& basis_trajectory() const { return basis_.trajectory; }

 private:
  Study study_;
  BasisCase basis_;
  AssessmentContext context_;
  Assessor assessor_;
};

std::string shell_text(const std::string& options) {
  return find_study("chapter2-shell").source + "\n[assessment.badwe2009]\n" + options + "\n";
}

}  // namespace

TEST_CASE(
    "badwe2009: of the Shell fractionator's inconsistencies only the mismatch is found, in its channel") {
  Bench bench(find_study("chapter2-shell"));
  CHECK_FALSE(bench.basis().flagged);
  const Assessment mismatch = bench.scenario(0);
  CHECK(mismatch.status == AssessmentStatus::ok);
  CHECK(mismatch.flagged);
  CHECK(mismatch.flagged_channels == std::vector<Channel>{{0, 0}});
  CHECK(mismatch.worst_cv() == 0);
  CHECK(mismatch.cvs[0].flagged == true);
  CHECK(mismatch.cvs[1].flagged == false);
  CHECK(mismatch.score == mismatch.number("strength", 0, 0));
  CHECK(mismatch.score > 1.0);
  CHECK_FALSE(bench.scenario(1).flagged);  // an unmeasured disturbance
}

TEST_CASE("badwe2009: a record that is too short does not apply, one without a free MV gives no answer") {
  Bench bench(find_study("chapter2-shell"));
  AssessedLoop loop = bench.loop_of(bench.basis_trajectory());
  loop.u.colwise() = Eigen::Vector3d(20.0, -20.0, 20.0);  // the limits of table 2.2
  loop.u(0, 0) = 19.0;
  const Assessment saturated = bench.assess(loop);
  CHECK(saturated.status == AssessmentStatus::failed);
  CHECK_THAT(saturated.reason, Catch::Contains("no MV is left"));

  loop = bench.loop_of(bench.basis_trajectory());
  for (Eigen::MatrixXd* signals : {&loop.y, &loop.u, &loop.u_target, &loop.d, &loop.y_sim, &loop.y_set})
    *signals = signals->leftCols(119).eval();
  const Assessment brief = bench.assess(loop);
  CHECK(brief.status == AssessmentStatus::not_applicable);
  CHECK_THAT(brief.reason, Catch::Contains("need 120 samples, and the record has 119"));
}

TEST_CASE("badwe2009: every option of a study file arrives") {
  const Badwe2009Options options =
      parse_study(shell_text("filter = 'first-order'\nfilter_length = 7\nmodel = 'output-error'\nnb = 3\n"
                             "nf = 4\nfir_length = 9\nfir_pole = 0.5\nmin_lag = 2\nmax_lag = 11\n"
                             "confidence = 0.9\nmultiplicity = 'lags'\nweakest_correlation = 0.1\n"
                             "saturated_share = 0.2\nsmallest_deviation = 0.01\nsmallest_own_share = 0.02"),
                  "s.toml")
          .assessment.of<Badwe2009Options>();
  CHECK(options.filter == NoiseFilter::first_order);
  CHECK(options.filter_length == 7);
  CHECK(options.models.model == DecorrelationModel::output_error);
  CHECK(options.models.nb == 3);
  CHECK(options.models.nf == 4);
  CHECK(options.models.fir_length == 9);
  CHECK(options.models.fir_pole == 0.5);
  CHECK(options.min_lag == 2);
  CHECK(options.max_lag == 11);
  CHECK(options.confidence == 0.9);
  CHECK(options.multiplicity == Multiplicity::lags);
  CHECK(options.weakest_correlation == 0.1);
  CHECK(options.saturated_share == 0.2);
  CHECK(options.smallest_deviation == 0.01);
  CHECK(options.smallest_own_share == 0.02);
  CHECK_THROWS_WITH(parse_study(shell_text("fir_pole = 1"), "s.toml"), Catch::Contains("fir_pole"));
  CHECK_THROWS_WITH(parse_study(shell_text("min_lag = 5\nmax_lag = 4"), "s.toml"),
                    Catch::Contains("max_lag"));
  CHECK_THROWS_WITH(parse_study(shell_text("model = 'arx'"), "s.toml"), Catch::Contains("output-error"));
}

}  // namespace mpm
