#include <cmath>
#include <memory>

#include <catch2/catch.hpp>

#include "analysis/experiment/experiment.hpp"
#include "analysis/experiment/judgement.hpp"
#include "plants/error.hpp"
#include "plants/non_finite.hpp"
#include "plants/nonlinear/quadruple_tank.hpp"
#include "scenarios/files/study_library.hpp"
#include "tests/solvers/active_set_factory.hpp"

// What a plant cannot do is the outcome of an experiment, unless it is the study's plant.

namespace {

using namespace mpm;
using Catch::Contains;

/// The tank, unless it is broken: then it rests nowhere, or its equations are not finite.
class BrittleTank final : public OdeSystem {
 public:
  BrittleTank(bool rests, bool moves)
      : tank_(quadruple_tank_parameters("table-2.6")), rests_(rests), moves_(moves) {}

  Eigen::Index state_count() const override { return tank_.state_count(); }
  Eigen::Index input_count() const override { return tank_.input_count(); }
  Eigen::Index output_count() const override { return tank_.output_count(); }
  void derivative(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& u,
                  Eigen::Ref<Eigen::VectorXd> dx) const override {
    tank_.derivative(x, u, dx);
    if (!moves_)
      dx.setConstant(NAN);
  }
  void jacobian(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& u,
                Eigen::Ref<Eigen::MatrixXd> J) const override {
    tank_.jacobian(x, u, J);
  }
  void output(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& u,
              Eigen::Ref<Eigen::VectorXd> y) const override {
    tank_.output(x, u, y);
  }
  Eigen::VectorXd steady_state(const Eigen::Ref<const Eigen::VectorXd>& u) const override {
    const bool operating_point = u == quadruple_tank_operating_point();
    return rests_ || operating_point ? tank_.steady_state(u)
                                     : Eigen::VectorXd::Constant(state_count(), mpm::kInfinity);
  }

 private:
  QuadrupleTank tank_;
  bool rests_, moves_;
};

/// A study on the nonlinear tank whose loops begin at the economic optimum, not at the operating point.
Study tank_study() {
  return find_study("chapter2-tank");
}

TEST_CASE("a plant without a steady state to begin at fails the experiment, and says why") {
  Study study = tank_study();
  study.scenarios = {{"M1", "", {}, {}, std::vector<Eigen::Index>{0}, {{"cd2", 2.0}}},
                     {"none", "", {}, {}, {}}};
  study.nonlinear->model.make_system = [](const std::vector<ParameterChange>& changes) {
    return std::make_shared<const BrittleTank>(changes.empty(), true);
  };
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  ExperimentRunner runner(study, basis, {"botelho"}, testing::kFactory);
  const ExperimentRecord failed = runner.run(0, StorePolicy::all);
  CHECK(failed.status == ExperimentStatus::failed);
  CHECK_THAT(failed.message, Contains("the plant has no steady state to begin at") && Contains("not finite"));
  CHECK(failed.loop->trajectory.samples_done == 0);
  CHECK(failed.solver.steps == 0);
  REQUIRE(failed.assessments.size() == 1);
  CHECK(failed.assessments[0].status == AssessmentStatus::not_assessed);
  CHECK_FALSE(judge(study, failed, failed.assessments[0]).wrong());
  const ExperimentRecord next = runner.run(1, StorePolicy::none);  // the runner is none the worse for it
  CHECK(next.status == ExperimentStatus::ok);
  CHECK(next.message.empty());
}

TEST_CASE("a plant that cannot be integrated fails the experiment, not the basis case") {
  Study study = tank_study();
  study.scenarios = {{"M1", "", {}, {}, std::vector<Eigen::Index>{0}, {{"cd2", 2.0}}}};
  study.nonlinear->model.make_system = [](const std::vector<ParameterChange>& changes) {
    return std::make_shared<const BrittleTank>(true, changes.empty());
  };
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  REQUIRE(basis.trajectory.status == ControlStatus::ok);
  const ExperimentRecord failed =
      ExperimentRunner(study, basis, {"botelho"}, testing::kFactory).run(0, StorePolicy::none);
  CHECK(failed.status == ExperimentStatus::failed);
  CHECK(failed.message == "the plant could not be integrated");
}

TEST_CASE("a study whose own plant cannot rest where its loops begin is refused") {
  Study study = tank_study();
  study.nonlinear->model.make_system = [](const std::vector<ParameterChange>&) {
    return std::make_shared<const BrittleTank>(false, true);
  };
  CHECK_THROWS_AS(run_basis_case(study, testing::kFactory), InputError);
  CHECK_THROWS_WITH(run_basis_case(study, testing::kFactory),
                    Contains("found the plant has no steady state to begin at") && Contains("not finite"));
}

TEST_CASE("a basis case whose plant cannot be integrated is not healthy, and says why") {
  Study study = tank_study();
  study.nonlinear->model.make_system = [](const std::vector<ParameterChange>&) {
    return std::make_shared<const BrittleTank>(true, false);
  };
  const BasisCase basis = run_basis_case(study, testing::kFactory);
  CHECK_FALSE(basis.healthy);
  CHECK(basis.explanation == "the nominal loop fails at sample 0: the plant could not be integrated");
}

}  // namespace
