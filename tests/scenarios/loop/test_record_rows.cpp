#include <algorithm>
#include <cmath>
#include <memory>

#include <catch2/catch.hpp>

#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "plants/linear/linear_plant.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/historian.hpp"
#include "scenarios/loop/record_rows.hpp"
#include "scenarios/loop/signals.hpp"
#include "scenarios/study/study_controller.hpp"
#include "tests/scenarios/study_texts.hpp"
#include "tests/solvers/active_set_factory.hpp"

// Records whose rows are means over a sample, or off by a part of one, against fine simulation.

namespace mpm {
namespace {

using namespace testing;

/// Steps of a fine simulation within a sample; even.
constexpr Eigen::Index kFine = 400;
/// Simpson's rule with steps of Ts / 400 on responses with time constants of a sample or more errs by 1e-12.
constexpr double kExact = 1e-9;

Eigen::MatrixXd fine_inputs(const Eigen::MatrixXd& inputs) {
  Eigen::MatrixXd fine(inputs.rows(), inputs.cols() * kFine + 1);
  for (Eigen::Index k = 0; k < fine.cols(); ++k)
    fine.col(k) = inputs.col(std::min(k / kFine, inputs.cols() - 1));
  return fine;
}

/// The row at time (k + shift) Ts of a fine signal, of which the first sample stands for the time before.
double fine_row(const Eigen::RowVectorXd& fine, OutputSampling sampling, double shift, Eigen::Index k) {
  const auto at = [&](Eigen::Index place) {
    return fine(std::clamp<Eigen::Index>(place, 0, fine.size() - 1));
  };
  const auto end =
      static_cast<Eigen::Index>(std::llround((static_cast<double>(k) + shift) * static_cast<double>(kFine)));
  if (sampling == OutputSampling::snapshot)
    return at(end);
  double sum = 0.0;
  for (Eigen::Index i = end - kFine; i < end; i += 2)
    sum += (at(i) + 4.0 * at(i + 1) + at(i + 2)) / 3.0;
  return sum / static_cast<double>(kFine);
}

Study resampled(Study study, OutputSampling sampling, std::vector<double> shift) {
  study.record.sampling = sampling;
  study.record.cv_shift = std::move(shift);
  return study;
}

/// Without noise, whose rows are those of single measurements.
Study quiet(const std::string& name) {
  Study study = find_study(name);
  study.simulation.noise_standard_deviation.setZero();
  return study;
}

/// The inputs of the plant under which the loop starts, MVs and then `others`.
Eigen::VectorXd start_of(const Study& study, Eigen::Index others) {
  const std::unique_ptr<Controller> controller = controller_of(study, study.controller, kFactory);
  controller->set_setpoints(study.simulation.initial_setpoint);
  Eigen::VectorXd input = Eigen::VectorXd::Zero(study.mv_count() + others);
  input.head(study.mv_count()) = controller->nominal_target(Eigen::VectorXd::Zero(study.md_count()));
  return input;
}

/// The plant of the loop, simulated finely under the MVs of the loop.
Eigen::MatrixXd fine_output(const Study& study, const TransferMatrix& plant, const Trajectory& loop) {
  Eigen::MatrixXd inputs(loop.u.rows() + loop.d.rows(), loop.u.cols());
  inputs << loop.u, loop.d;
  const Eigen::MatrixXd fine = fine_inputs(inputs);
  LinearPlant simulated(plant, study.controller.sample_time / static_cast<double>(kFine));
  simulated.reset(start_of(study, loop.d.rows()));
  Eigen::MatrixXd y(plant.rows(), fine.cols());
  for (Eigen::Index k = 0; k < fine.cols(); ++k) {
    y.col(k) = simulated.output();
    simulated.advance(fine.col(k));
  }
  return y;
}

void check_rows(const Study& study, const ExperimentDraw& draw, const TransferMatrix& plant) {
  const Trajectory loop = simulate_experiment(study, draw, kFactory);
  REQUIRE(loop.status == ControlStatus::ok);
  const Eigen::MatrixXd fine = fine_output(study, plant, loop);
  const Eigen::MatrixXd y = recorded(study, draw.index, loop).y;
  const double size = loop.y.cwiseAbs().maxCoeff();
  for (Eigen::Index cv = 0; cv < y.rows(); ++cv) {
    const RowTime time = row_time(study.record, VariableSort::cv, cv);
    double worst = 0.0;
    for (Eigen::Index k = 0; k < y.cols(); ++k)
      worst = std::max(worst, std::abs(y(cv, k) - fine_row(fine.row(cv), time.sampling, time.shift, k)));
    INFO(study.plant.cvs[static_cast<std::size_t>(cv)].name << " shifted by " << time.shift);
    CHECK(worst < kExact * size);
  }
}

}  // namespace

TEST_CASE("rows of a linear loop are those of a fine simulation", "[record]") {
  const Study study = quiet("wood-berry");  // dead times of 1 to 8.1 min, sampled each minute
  for (const OutputSampling sampling : {OutputSampling::snapshot, OutputSampling::average})
    for (const std::vector<double>& shift :
         {std::vector<double>{0.0, 0.0}, {-0.5, 0.25}, {-1.0, 1.0}, {-2.75, 0.6}}) {
      const Study recording = resampled(study, sampling, shift);
      check_rows(recording, basis_draw(), study.plant.G);
      ExperimentDraw draw = basis_draw();
      draw.kind = ExperimentKind::mpm;
      draw.mismatches = {{0, 0, MismatchParameter::gain, 1.5}, {1, 1, MismatchParameter::dead_time, 0.4}};
      check_rows(recording, draw, with_mismatches(study.plant.G, draw.mismatches));
    }
}

TEST_CASE("rows of a level, which integrates, are those of a fine simulation", "[record]") {
  const Study study = quiet("suite-evaporator");
  Study recording = resampled(study, OutputSampling::average, {0.0, -0.5, 0.3});
  check_rows(recording, basis_draw(), study.plant.G);
}

TEST_CASE("rows of a plant of step coefficients are those of straight lines between them", "[record]") {
  Study study = quiet("wood-berry");
  Eigen::VectorXd step(60);
  for (Eigen::Index i = 0; i < step.size(); ++i)
    step(i) = 2.0 * (1.0 - std::exp(-0.1 * static_cast<double>(i + 1)));
  TransferFunction& channel = study.plant.G(0, 0);
  channel = channel.with_step_coefficients(step, 1.0);
  check_rows(resampled(study, OutputSampling::average, {-0.5, 0.0}), basis_draw(), study.plant.G);
}

TEST_CASE("a disturbance has its rows from its own response", "[record]") {
  const Study study = quiet("wood-berry");
  const Study recording = resampled(study, OutputSampling::average, {-0.5, 0.0});
  ExperimentDraw draw = basis_draw();
  draw.kind = ExperimentKind::ud;
  draw.disturbances = {{0, 0.5, 30.0}};
  draw.index = 3;
  // With the response of v through G_d as that of one more input of the plant.
  const Trajectory loop = simulate_experiment(recording, draw, kFactory);
  TransferMatrix with_input(2, study.plant.G.cols() + 1);
  for (Eigen::Index cv = 0; cv < 2; ++cv)
    for (Eigen::Index input = 0; input < study.plant.G.cols(); ++input)
      with_input(cv, input) = study.plant.G(cv, input);
  with_input(0, study.plant.G.cols()) = TransferFunction::first_order(0.5, 30.0);
  const Eigen::RowVectorXd v = disturbance_signal(
      draw.disturbances[0].signal, study.disturbance.v_standard_deviation, study.controller.sample_time,
      study.simulation.samples, experiment_stream(study, draw.index, StreamId::disturbance_signal));
  Trajectory with_v = loop;
  with_v.d.resize(loop.d.rows() + 1, loop.d.cols());
  with_v.d << loop.d, v;
  const Eigen::MatrixXd fine = fine_output(study, with_input, with_v);
  const Eigen::MatrixXd y = recorded(recording, draw.index, loop).y;
  for (Eigen::Index k = 0; k < y.cols(); ++k)
    REQUIRE(std::abs(y(0, k) - fine_row(fine.row(0), OutputSampling::average, -0.5, k)) < kExact);
}

TEST_CASE("rows of a nonlinear plant are those of a fine integration", "[record]") {
  Study study = find_study("suite-tank");
  REQUIRE(study.nonlinear);
  study.simulation.noise_standard_deviation.setZero();
  study.simulation.samples = 120;
  study.nonlinear->integration.relative_tolerance = 1e-12;
  study.nonlinear->integration.absolute_tolerance = 1e-12;
  const Study recording = resampled(study, OutputSampling::average,
                                    std::vector<double>(static_cast<std::size_t>(study.cv_count()), -0.25));
  const ExperimentDraw draw = basis_draw();
  const Trajectory loop = simulate_experiment(recording, draw, kFactory);
  REQUIRE(loop.status == ControlStatus::ok);
  Study finely = study;
  finely.controller.sample_time /= static_cast<double>(kFine);
  const std::unique_ptr<Plant> plant = experiment_plant(finely, draw);
  Eigen::VectorXd input = start_of(study, plant->input_count() - study.mv_count());
  plant->reset(input);
  Eigen::MatrixXd fine(loop.y.rows(), loop.u.cols() * kFine + 1);
  for (Eigen::Index k = 0; k < fine.cols(); ++k) {
    fine.col(k) = plant->output();
    const Eigen::Index sample = std::min(k / kFine, loop.u.cols() - 1);
    input.head(loop.u.rows()) = loop.u.col(sample);
    input.segment(loop.u.rows(), loop.d.rows()) = loop.d.col(sample);
    plant->advance(input);
  }
  const Eigen::MatrixXd y = recorded(recording, 0, loop).y;
  for (Eigen::Index cv = 0; cv < y.rows(); ++cv)
    for (Eigen::Index k = 1; k < y.cols(); ++k)
      REQUIRE(std::abs(y(cv, k) - fine_row(fine.row(cv), OutputSampling::average, -0.25, k)) < kExact);
}

TEST_CASE("the controller and the truth see snapshots, whatever the record is", "[record]") {
  const Study study = find_study("wood-berry");
  const Trajectory loop = simulate_experiment(study, draw_experiment(study, 2), kFactory);
  const Study recording = resampled(study, OutputSampling::average, {-0.5, 0.0});
  const Trajectory other = simulate_experiment(recording, draw_experiment(recording, 2), kFactory);
  CHECK(loop.y == other.y);
  CHECK(loop.u == other.u);
  CHECK(loop.y_sampled.size() == 0);
  CHECK(recorded(recording, 2, other).y != other.y);
  CHECK(recorded(study, 2, loop).y == loop.y);
}

TEST_CASE("whole samples move rows, noise and all; MVs and MDs are held", "[record]") {
  Study study = find_study("wood-berry");
  study.record.cv_shift = {1.0, -2.0};
  study.record.mv_shift = {-0.5, 0.0};
  const Trajectory loop = simulate_experiment(study, draw_experiment(study, 1), kFactory);
  const Trajectory kept = recorded(study, 1, loop);
  const Eigen::Index N = loop.y.cols();
  CHECK((kept.y.row(0).head(N - 1) - loop.y.row(0).tail(N - 1)).cwiseAbs().maxCoeff() < 1e-12);
  CHECK((kept.y.row(1).tail(N - 2) - loop.y.row(1).head(N - 2)).cwiseAbs().maxCoeff() < 1e-12);
  CHECK(kept.u.row(0).tail(N - 1) == loop.u.row(0).head(N - 1));
  CHECK(kept.u.row(1) == loop.u.row(1));
}

TEST_CASE("rows of lines and of held signals, by hand", "[record]") {
  const Eigen::RowVectorXd signal = Eigen::RowVector4d(0.0, 2.0, 6.0, 6.0);
  const auto mean = [](double shift) { return RowTime{OutputSampling::average, shift}; };
  CHECK(rows_of_held(mean(0.0), signal) == Eigen::RowVector4d(0.0, 0.0, 2.0, 6.0));
  CHECK(rows_of_held(mean(0.5), signal) == Eigen::RowVector4d(0.0, 1.0, 4.0, 6.0));
  CHECK(rows_of_line(mean(0.0), signal) == Eigen::RowVector4d(0.0, 1.0, 4.0, 6.0));
  CHECK(rows_of_line(mean(-0.5), signal) == Eigen::RowVector4d(0.0, 0.25, 2.25, 5.5));
  CHECK(rows_of_line({OutputSampling::snapshot, 0.25}, signal) == Eigen::RowVector4d(0.5, 3.0, 6.0, 6.0));
  CHECK(rows_of_held({OutputSampling::snapshot, -0.25}, signal) == Eigen::RowVector4d(0.0, 0.0, 2.0, 6.0));
}

TEST_CASE("the keys of rows land in their place, and what is none is refused", "[record]") {
  const auto with = [](const std::string& keys) { return small_study() + "\n[record]\n" + keys; };
  const Study named =
      parse_study(with("sampling = 'average'\nshift = {level = -0.5, hot = 1, drain = -2}\n"), "s.toml");
  CHECK(named.record.sampling == OutputSampling::average);
  CHECK(named.record.cv_shift == std::vector{-0.5, 0.0});
  CHECK(named.record.mv_shift == std::vector{1.0, 0.0});
  CHECK(named.record.md_shift == std::vector{-2.0});
  const Study all = parse_study(with("shift = 1\n"), "s.toml");
  CHECK(all.record.cv_shift == std::vector{1.0, 1.0});
  CHECK(all.record.mv_shift.empty());
  CHECK(all.record.resamples());
  CHECK_FALSE(all.record.looks_between_samples());
  CHECK_THAT(refusal(with("shift = 2\n")), Catch::Contains("shift"));
  CHECK_THAT(refusal(with("shift = {nobody = 1}\n")), Catch::Contains("nobody"));
  CHECK_THAT(refusal(with("sampling = 'mean'\n")), Catch::Contains("average"));
}

}  // namespace mpm
