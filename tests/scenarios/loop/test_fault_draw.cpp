#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "analysis/study_files/study_change.hpp"
#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "plants/linear/linear_plant.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/loop/fault_draw.hpp"
#include "scenarios/loop/signals.hpp"
#include "tests/scenarios/study_texts.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace {

using namespace mpm;

/// Chapter 6 with disturbances of one shape.
Study study_with(DisturbanceShape shape) {
  Study study = find_study("chapter6");
  study.experiments = {.ud = 1};
  study.simulation.samples = 2000;
  study.disturbance.time_constant = Distribution::constant(40.0);
  study.disturbance.signal_weight.fill(0.0);
  study.disturbance.signal_weight[static_cast<std::size_t>(shape)] = 1.0;
  return study;
}

Eigen::RowVectorXd output_of(const Study& study, std::int64_t index) {
  const ExperimentDraw draw = draw_experiment(study, index);
  return unmeasured_disturbances(study, draw).row(draw.true_cv());
}

double power_at(const Eigen::RowVectorXd& y, double period_in_samples) {
  double cosine = 0.0, sine = 0.0;
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    const double phase = 2.0 * std::numbers::pi * static_cast<double>(k) / period_in_samples;
    cosine += y(k) * std::cos(phase);
    sine += y(k) * std::sin(phase);
  }
  return 2.0 * (cosine * cosine + sine * sine) / static_cast<double>(y.size() * y.size());
}

TEST_CASE("random disturbances: every shape has the variance that white noise has on the average") {
  for (const DisturbanceShape shape : kDisturbanceShapes) {
    const Study study = study_with(shape);
    double ratio = 0.0;
    constexpr int kExperiments = 60;
    for (std::int64_t i = 0; i < kExperiments; ++i) {
      const ExperimentDraw draw = draw_experiment(study, i);
      const Eigen::RowVectorXd y = output_of(study, i);
      // var of gain / (40 s + 1) behind a hold of 4 under unit white noise: gain^2 (1 - a) / (1 + a).
      const double a = std::exp(-4.0 / 40.0);
      const double gain = draw.disturbances.front().gain;
      const double variance = (y.array() - y.mean()).square().mean();
      ratio += variance / (gain * gain * (1.0 - a) / (1.0 + a)) / kExperiments;
    }
    INFO(to_string(shape));
    CHECK(ratio == Approx(1.0).epsilon(shape == DisturbanceShape::white ? 0.1 : 1e-9));
  }
}

TEST_CASE("random disturbances: each shape is what it is called") {
  for (std::int64_t i = 0; i < 20; ++i) {
    const Study sine = study_with(DisturbanceShape::sine);
    const ExperimentDraw draw = draw_experiment(sine, i);
    const double period =
        std::get<Sine>(draw.disturbances.front().signal).period / sine.controller.sample_time;
    const Eigen::RowVectorXd y = output_of(sine, i).tail(1500);
    CHECK(power_at(y, period) > 0.8 * y.array().square().mean());

    const Eigen::RowVectorXd step = output_of(study_with(DisturbanceShape::step), i);
    CHECK(step.head(190).isZero(0));
    CHECK(step(1999) == Approx(step(1990)).epsilon(1e-6));

    const Eigen::RowVectorXd ramp = output_of(study_with(DisturbanceShape::ramp), i);
    CHECK(ramp(1999) - ramp(1989) == Approx(ramp(1899) - ramp(1889)).epsilon(1e-6));
  }
  // A random walk through G_d has the spectrum of 1 / f^2 at low frequencies: slower is stronger.
  double slow = 0.0, fast = 0.0, quiet = 0.0;
  for (std::int64_t i = 0; i < 40; ++i) {
    const Eigen::RowVectorXd walk = output_of(study_with(DisturbanceShape::random_walk), i);
    slow += power_at(walk, 1000.0);
    fast += power_at(walk, 250.0);
    Study bursts = study_with(DisturbanceShape::burst);
    const ExperimentDraw draw = draw_experiment(bursts, i);
    const Eigen::RowVectorXd v =
        disturbance_signal(draw.disturbances.front().signal, 1.0, 4.0, 2000,
                           RandomStream(1, static_cast<std::uint64_t>(i), StreamId::kind));
    quiet += static_cast<double>((v.array() == 0.0).count()) / 2000.0 / 40.0;
  }
  // Two squares of normal numbers a loop, 40 loops: the ratio scatters by a fifth, and 0.5 is 2.5 of that.
  CHECK(slow / fast == Approx(16.0).epsilon(0.5));
  CHECK(quiet == Approx(0.8).epsilon(0.1));  // pause 80, length 20
}

TEST_CASE("random disturbances: places are one CV, an MV with its CVs, or several CVs with one v") {
  Study study = find_study("chapter6");
  study.experiments = {.ud = 1};
  study.disturbance.place_weight = {1.0, 1.0, 1.0};
  std::map<std::size_t, int> places;
  int on_mv = 0;
  for (std::int64_t i = 0; i < 200; ++i) {
    const ExperimentDraw draw = draw_experiment(study, i);
    const Disturbance& first = draw.disturbances.front();
    if (first.mv) {
      ++on_mv;
      const Eigen::VectorXd gains = study.plant.G.static_gain().col(*first.mv).cwiseAbs();
      CHECK(draw.affected().size() == static_cast<std::size_t>((gains.array() > 0.0).count()));
      CHECK(unmeasured_disturbances(study, draw).isZero(0));
      CHECK_FALSE(disturbances_of_mvs(study, draw).row(*first.mv).isZero(0));
      CHECK(first.gain * gains.maxCoeff() >= 0.1);
      continue;
    }
    ++places[draw.disturbances.size()];
    std::set<Eigen::Index> cvs;
    for (const Disturbance& disturbance : draw.disturbances)
      cvs.insert(disturbance.cv);
    CHECK(cvs.size() == draw.disturbances.size());
    CHECK(draw.affected().size() == cvs.size());
    if (draw.disturbances.size() < 2)
      continue;
    // The same v through two first-order lags: G_d1 y_2 = G_d2 y_1. With equal lags they are proportional.
    ExperimentDraw equal = draw;
    equal.disturbances[1].time_constant = first.time_constant;
    const Eigen::MatrixXd y = unmeasured_disturbances(study, equal);
    const double ratio = equal.disturbances[1].gain / first.gain;
    CHECK((y.row(equal.disturbances[1].cv) - ratio * y.row(first.cv)).cwiseAbs().maxCoeff() < 1e-10);
  }
  CHECK(on_mv > 40);
  CHECK(places[1] > 40);
  CHECK(places[2] > 15);
  CHECK(places[3] > 15);
}

TEST_CASE("random mismatches: extents are a channel, a CV, the actuator of an MV or the whole plant") {
  Study study = find_study("chapter6");
  study.experiments = {.mpm = 1};
  const auto draws_with = [&](MismatchExtent extent) {
    study.mismatch.extent_weight.fill(0.0);
    study.mismatch.extent_weight[static_cast<std::size_t>(extent)] = 1.0;
    return draw_experiment(study, 3).mismatches;
  };
  const std::vector<Mismatch> one = draws_with(MismatchExtent::parameter);
  REQUIRE(one.size() == 1);
  const std::vector<Mismatch> channel = draws_with(MismatchExtent::channel);
  REQUIRE(channel.size() == 3);
  const std::vector<Mismatch> cv = draws_with(MismatchExtent::cv);
  CHECK(cv.size() == 3);
  for (const Mismatch& mismatch : cv)
    CHECK((mismatch.cv == one[0].cv && mismatch.parameter == one[0].parameter));
  const std::vector<Mismatch> mv = draws_with(MismatchExtent::mv);
  CHECK(mv.size() == 7);
  for (const Mismatch& mismatch : mv)
    CHECK((mismatch.input == one[0].input && mismatch.value == mv[0].value &&
           mismatch.parameter == MismatchParameter::gain));
  const std::vector<Mismatch> plant = draws_with(MismatchExtent::plant);
  CHECK(plant.size() == 21);
  std::set<double> values;
  for (const Mismatch& mismatch : plant) {
    CHECK(mismatch.parameter == one[0].parameter);
    values.insert(mismatch.value);
  }
  CHECK(values.size() == 21);  // each by its own amount
}

TEST_CASE("mismatches: a further lag, an inverse response and a sign, by their step responses") {
  const TransferMatrix model{{TransferFunction::first_order(2.0, 10.0, 3.0)}};
  const auto response = [&](MismatchParameter parameter, double value) {
    return step_response(with_mismatches(model, {{0, 0, parameter, value}}), 1.0, 300)[0].row(0).eval();
  };
  const Eigen::RowVectorXd lag = response(MismatchParameter::second_order, 5.0);
  const Eigen::RowVectorXd inverse = response(MismatchParameter::inverse_response, 5.0);
  const Eigen::RowVectorXd sign = response(MismatchParameter::sign, -1.0);
  for (int k = 0; k < 300; ++k) {
    const double t = std::max(0.0, k + 1 - 3.0);
    // Partial fractions of 2 / ((10 s + 1)(5 s + 1) s) and 2 (1 - 5 s) / ((10 s + 1)(5 s + 1) s).
    CHECK(lag(k) == Approx(2.0 * (1.0 - 2.0 * std::exp(-t / 10.0) + std::exp(-t / 5.0))).margin(1e-12));
    CHECK(inverse(k) ==
          Approx(2.0 * (1.0 - 3.0 * std::exp(-t / 10.0) + 2.0 * std::exp(-t / 5.0))).margin(1e-12));
    CHECK(sign(k) == Approx(-2.0 * (1.0 - std::exp(-t / 10.0))).margin(1e-12));
  }
  CHECK(inverse.minCoeff() < -0.1);
}

TEST_CASE("onset: before it a faulty loop is the healthy one, to the bit") {
  Study study = find_study("chapter6");
  study.simulation.samples = 120;
  study.disturbance.place_weight = {1.0, 1.0, 1.0};
  study.experiments = {.mpm = 1, .ud = 1, .mpm_ud = 1, .other = 2};
  study.onset = {Distribution::uniform(40.0, 60.0), Distribution::constant(20.0)};
  for (std::int64_t i = 0; i < 10; ++i) {
    const ExperimentDraw draw = draw_experiment(study, i);
    CHECK((draw.onset.sample >= 40 && draw.onset.sample < 60));
    CHECK(draw.onset.growth == 20);
    ExperimentDraw healthy;
    healthy.index = i;
    const Trajectory faulty = simulate_experiment(study, draw, testing::kFactory);
    const Trajectory without = simulate_experiment(study, healthy, testing::kFactory);
    const Eigen::Index before = draw.onset.sample;
    CHECK((faulty.y.leftCols(before) - without.y.leftCols(before)).cwiseAbs().maxCoeff() < 1e-9);
    CHECK((faulty.y - without.y).cwiseAbs().maxCoeff() > 1e-6);
  }
  CHECK(Onset{10, 4}.share(9) == 0.0);
  CHECK(Onset{10, 4}.share(11) == 0.25);
  CHECK(Onset{10, 4}.share(14) == 1.0);
  CHECK(Onset{10, 0}.share(10) == 1.0);
}

TEST_CASE("faults that a study does not ask for leave its draws as they were") {
  Study study = find_study("chapter6");
  CHECK(study.has_plain_faults());
  // The first draws of chapter6 as the program drew them before there were others.
  const ExperimentDraw mismatch = draw_experiment(study, 0);
  REQUIRE(mismatch.mismatches.size() == 1);
  study.onset.sample = Distribution::constant(10.0);
  CHECK_FALSE(study.has_plain_faults());
  CHECK(draw_experiment(study, 0).mismatches == mismatch.mismatches);
  study.disturbance.signal_weight.fill(1.0);
  study.mismatch.extent_weight = {1.0, 0.0, 0.0, 0.0};
  for (std::int64_t i = 0; i < 30; ++i) {
    const ExperimentDraw plain = draw_experiment(find_study("chapter6"), i);
    const ExperimentDraw rich = draw_experiment(study, i);
    CHECK(plain.mismatches == rich.mismatches);
    REQUIRE(plain.disturbances.size() == rich.disturbances.size());
    if (plain.disturbances.empty())
      continue;
    CHECK(plain.disturbances[0].gain == rich.disturbances[0].gain);
    CHECK(plain.disturbances[0].cv == rich.disturbances[0].cv);
  }
}

/// Chapter 6 with faults on these channels and CVs, as lists of a study file.
Study confined(const std::string& channels, const std::string& cvs) {
  return changed_study(find_study("chapter6"), {{"mismatch.channels", channels}, {"disturbance.cvs", cvs}},
                       "--set");
}

TEST_CASE("faults stay on the channels and CVs that a study names") {
  const Study all = find_study("chapter6"), one = confined("['y1/u1']", "['y1']");
  int mismatches = 0, disturbances = 0;
  for (std::int64_t i = 0; i < 60; ++i) {
    const ExperimentDraw draw = draw_experiment(one, i), before = draw_experiment(all, i);
    CHECK(draw.kind == before.kind);
    for (const Mismatch& mismatch : draw.mismatches) {
      CHECK((mismatch.cv == 0 && mismatch.input == 0));
      CHECK(mismatch.parameter == before.mismatches.front().parameter);  // the other draws are as they were
      ++mismatches;
    }
    for (const Disturbance& disturbance : draw.disturbances) {
      CHECK(disturbance.cv == 0);
      CHECK(disturbance.gain == before.disturbances.front().gain);
      ++disturbances;
    }
  }
  CHECK(mismatches > 20);
  CHECK(disturbances > 20);
}

TEST_CASE("to name every channel and every CV, in any order, is to name none") {
  const Study all = find_study("chapter6");
  std::string cvs, channels;
  for (const auto& [cv, mv] : mv_channels(all))
    channels.insert(0, fmt::format("'{}/{}', ", all.plant.cvs[static_cast<std::size_t>(cv)].name,
                                   all.plant.mvs[static_cast<std::size_t>(mv)].name));
  for (const auto& cv : all.plant.cvs)
    cvs.insert(0, fmt::format("'{}', ", cv.name));
  const Study every = confined("[" + channels + "]", "[" + cvs + "]");
  for (std::int64_t i = 0; i < 60; ++i) {
    const ExperimentDraw draw = draw_experiment(every, i), before = draw_experiment(all, i);
    CHECK(draw.mismatches == before.mismatches);
    REQUIRE(draw.disturbances.size() == before.disturbances.size());
    for (std::size_t k = 0; k < draw.disturbances.size(); ++k)
      CHECK((draw.disturbances[k].cv == before.disturbances[k].cv &&
             draw.disturbances[k].gain == before.disturbances[k].gain));
  }
}

TEST_CASE("no extent of a mismatch and no place of a disturbance reaches what the study does not name") {
  Study study = confined("['y2/u1', 'y1/u1', 'y1/u3']", "['y2', 'y1']");
  study.mismatch.extent_weight = {0.0, 0.0, 1.0, 1.0, 1.0};
  study.disturbance.place_weight = {0.0, 0.0, 1.0};
  std::set<ChannelPlace> changed;
  for (std::int64_t i = 0; i < 60; ++i) {
    const ExperimentDraw draw = draw_experiment(study, i);
    for (const Mismatch& mismatch : draw.mismatches)
      changed.emplace(mismatch.cv, mismatch.input);
    CHECK((draw.disturbances.empty() || draw.disturbances.size() == 2));
    for (const Disturbance& disturbance : draw.disturbances)
      CHECK(disturbance.cv <= 1);
  }
  CHECK(changed == std::set<ChannelPlace>{{0, 0}, {0, 2}, {1, 0}});
}

TEST_CASE("random parameters of a nonlinear plant: one of the list, with the CVs that it affects") {
  const std::string tank = testing::project_file("scenarios/studies/chapter5-tank.toml");
  const std::string text = tank.substr(0, tank.find("[[scenario]]")) +
                           "\n[experiments]\nmpm = 2\nud = 0\nmpm_ud = 0\n"
                           "[mismatch]\nplant_parameter = [\n"
                           "  {name = \"cd1\", factor = {uniform = [0.7, 0.9]}, affected = [\"h1\"]},\n"
                           "  {name = \"cd4\", factor = {constant = 1.5}, affected = [\"h2\", \"h4\"]}]\n";
  const Study study = parse_study(text, "tank.toml");
  std::set<std::string> names;
  for (std::int64_t i = 0; i < 20; ++i) {
    const ExperimentDraw draw = draw_experiment(study, i);
    REQUIRE(draw.parameters.size() == 1);
    CHECK(draw.kind == ExperimentKind::mpm);
    names.insert(draw.parameters[0].name);
    CHECK(draw.affected().size() == (draw.parameters[0].name == "cd1" ? 1 : 2));
  }
  CHECK(names == std::set<std::string>{"cd1", "cd4"});
}

}  // namespace
