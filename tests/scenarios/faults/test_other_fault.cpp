#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"
#include "scenarios/faults/other_fault.hpp"
#include "scenarios/faults/told_source.hpp"
#include "scenarios/faults/valve_stem.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/fault_draw.hpp"
#include "scenarios/loop/signals.hpp"
#include "scenarios/random/random_stream.hpp"
#include "tests/solvers/active_set_factory.hpp"

namespace {

using namespace mpm;

struct Cycle {
  double low, high, largest_jump, longest_rest;
};

/// The stem of a valve under a triangle of this amplitude and period, after the first period.
Cycle cycle_of(StickyValve valve, double amplitude, int period) {
  Cycle cycle{1e9, -1e9, 0.0, 0.0};
  double last = 0.0, rest = 0.0, u_last = 0.0;
  for (int k = 0; k < 4 * period; ++k) {
    const double phase = static_cast<double>(k % period) / period;
    const double u = amplitude * (phase < 0.25 ? 4 * phase : phase < 0.75 ? 2 - 4 * phase : 4 * phase - 4);
    const double x = valve.follow(u);
    if (k > period) {
      cycle.low = std::min(cycle.low, x);
      cycle.high = std::max(cycle.high, x);
      rest = x == last ? rest + std::abs(u - u_last) : 0.0;
      cycle.longest_rest = std::max(cycle.longest_rest, rest);
      if (x != last)
        cycle.largest_jump = std::max(cycle.largest_jump, std::abs(x - last));
    }
    last = x;
    u_last = u;
  }
  return cycle;
}

TEST_CASE("sticky valve: under a triangle it swings S - J less, rests over S and jumps by J") {
  constexpr double kAmplitude = 1.0;
  constexpr int kPeriod = 4000;
  const double move = 4.0 * kAmplitude / kPeriod;  // a sample
  for (const auto& [S, J] : {std::pair{0.5, 0.2}, {0.5, 0.0}, {0.3, 0.3}, {0.2, 0.5}}) {
    const Cycle cycle = cycle_of(StickyValve(S, J, 0.0), kAmplitude, kPeriod);
    // Closed form: the stem stands (S - J) / 2 behind the signal when it turns.
    CHECK(cycle.high - cycle.low == Approx(2 * kAmplitude - (S - J)).margin(3 * move));
    CHECK(cycle.longest_rest == Approx(S).margin(3 * move));
    CHECK(cycle.largest_jump == Approx(std::max(J, move)).margin(3 * move));
  }
}

TEST_CASE("sticky valve: without S and J it is no valve, and a signal within S never moves it") {
  StickyValve perfect(0.0, 0.0, 0.3), stuck(2.5, 1.2, 0.0);
  for (int k = 0; k < 100; ++k) {
    const double u = std::sin(0.2 * k);
    CHECK(perfect.follow(u) == u);
    CHECK(stuck.follow(u) == 0.0);
  }
  CHECK_THROWS_AS(StickyValve(-0.1, 0.0, 0.0), InputError);
  CHECK_THROWS_AS(StickyValve(0.1, std::nan(""), 0.0), InputError);
}

/// Steps of a random walk, as an MV makes them.
std::vector<double> walk(int steps) {
  RandomStream stream(5, 0, StreamId::excitation);
  std::vector<double> u{0.0};
  for (int k = 0; k < steps; ++k)
    u.push_back(u.back() + 0.1 * stream.normal());
  return u;
}

TEST_CASE("friction valve: it moves where the force exceeds f_S, and until f_D of it is left") {
  for (const auto& [f_S, f_D] : {std::pair{0.5, 0.2}, {0.5, 0.0}, {0.3, 0.3}}) {
    FrictionValve valve(f_S, f_D, 0.0);
    double x = 0.0;
    int moves = 0;
    for (const double u : walk(2000)) {
      const double before = std::exchange(x, valve.follow(u));
      CHECK(std::abs(u - x) <= f_S + 1e-12);
      CHECK((x == before) == (std::abs(u - before) <= f_S));
      if (x == before)
        continue;
      ++moves;
      CHECK(std::abs(u - x) == Approx(f_D).margin(1e-12));
      CHECK((u - x) * (x - before) >= 0.0);  // the force still points in the direction of the move
    }
    CHECK(moves > 20);
  }
  CHECK_THROWS_AS(FrictionValve(0.1, 0.2, 0.0), InputError);
}

TEST_CASE("friction valve: with f_D = 0 that of Stenman et al., with f_D = f_S a deadband") {
  FrictionValve stenman(0.4, 0.0, 0.0), lagging(0.3, 0.3, 0.0);
  StickyValve deadband(0.6, 0.0, 0.0);
  double x = 0.0;
  bool has_moved = false;  // at first the two stand elsewhere in the band
  for (const double u : walk(2000)) {
    x = std::abs(u - x) > 0.4 ? u : x;
    CHECK(stenman.follow(u) == x);
    const double a = lagging.follow(u), b = deadband.follow(u);
    has_moved = has_moved || std::abs(u) > 1.0;
    if (has_moved)
      CHECK(a == Approx(b).margin(1e-9));
  }
  CHECK(has_moved);
}

TEST_CASE("valves: from an unknown start the stem stands anywhere that it can, and moves beyond it") {
  constexpr double kStep = 1e-6;
  for (const double start : {-1.0, 1.0}) {
    for (const double towards : {-1.0, 1.0}) {
      StickyValve sticky(0.5, 0.2, 1.0, start);
      FrictionValve friction(0.4, 0.1, 1.0, start);
      const bool breaks_loose = towards * start < 0.0;  // the force grows
      CHECK((sticky.follow(1.0 + towards * kStep) != 1.0 + start * 0.35) == breaks_loose);
      CHECK((friction.follow(1.0 + towards * kStep) != 1.0 + start * 0.4) == breaks_loose);
    }
  }
  CHECK(StickyValve(0.5, 0.2, 1.0, 0.3).follow(1.0) == Approx(1.0 + 0.3 * 0.35));
}

TEST_CASE("other faults: every kind of valve is drawn with a start where a study asks for it") {
  Study study = find_study("chapter6");
  study.experiments = {.other = 1};
  study.other.weight.fill(0.0);
  for (const OtherFaultKind kind : {OtherFaultKind::stiction, OtherFaultKind::deadband,
                                    OtherFaultKind::stick_slip, OtherFaultKind::friction})
    study.other.weight[static_cast<std::size_t>(kind)] = 1.0;
  const ExperimentDraw known = draw_experiment(study, 7);
  CHECK(known.other->start == 0.0);
  study.other.valve_start = ValveStart::unknown;
  ExperimentDraw unknown = draw_experiment(study, 7);
  CHECK(unknown.other->start != 0.0);
  unknown.other->start = 0.0;
  CHECK(*unknown.other == *known.other);  // from a stream of its own
}

Study range_study() {
  Study study = find_study("chapter6");
  study.simulation.samples = 120;
  study.simulation.noise_standard_deviation.setZero();
  return study;
}

ExperimentDraw draw_of(OtherFaultKind kind, Eigen::Index variable, double size, Onset onset = {}) {
  ExperimentDraw draw;
  draw.kind = ExperimentKind::other;
  draw.other = OtherFault{kind, variable, size};
  draw.onset = onset;
  return draw;
}

TEST_CASE("other faults: a sensor adds its bias from the onset on, a drift goes to its size at the end") {
  const Study study = range_study();
  const Eigen::MatrixXd bias =
      sensor_errors(study, draw_of(OtherFaultKind::sensor_bias, 1, 0.4, {.sample = 20, .growth = 10}));
  CHECK(bias(1, 19) == 0.0);
  CHECK(bias(1, 25) == Approx(0.2));
  CHECK((bias.row(1).tail(90).array() == 0.4).all());
  CHECK((bias.row(0).isZero(0) && bias.row(2).isZero(0)));
  const Eigen::MatrixXd drift =
      sensor_errors(study, draw_of(OtherFaultKind::sensor_drift, 1, 0.4, {.sample = 19}));
  CHECK(drift(1, 19) == 0.0);
  CHECK(drift(1, 69) == Approx(0.2));
  CHECK(drift(1, 119) == Approx(0.4));
}

TEST_CASE("other faults: the measurement of an MD is wrong, the MD is not") {
  const Study study = range_study();
  const Eigen::MatrixXd d = measured_disturbances(study);
  const ExperimentDraw gain = draw_of(OtherFaultKind::md_gain, 0, 1.5, {.sample = 60});
  const Trajectory loop = simulate_experiment(study, gain, testing::kFactory);
  const Trajectory healthy = simulate_experiment(study, basis_draw(), testing::kFactory);
  REQUIRE(loop.status == ControlStatus::ok);
  CHECK(loop.d.row(0).head(60) == d.row(0).head(60));
  CHECK(loop.d.row(0).tail(60).isApprox(1.5 * d.row(0).tail(60), 1e-14));
  CHECK(loop.y.leftCols(60) == healthy.y.leftCols(60));
  CHECK(loop.u.rightCols(60) != healthy.u.rightCols(60));
  ExperimentDraw noise = draw_of(OtherFaultKind::md_noise, 0, 0.2);
  noise.index = 5;
  const Eigen::RowVectorXd error = measurements_of_mds(study, noise).row(0) - d.row(0);
  CHECK(std::sqrt(error.squaredNorm() / static_cast<double>(error.size())) == Approx(0.2).epsilon(0.2));
}

TEST_CASE("other faults: a held MV stays where it is and the record says so, a valve it does not see") {
  const Study study = range_study();
  const Trajectory healthy = simulate_experiment(study, basis_draw(), testing::kFactory);
  const Trajectory held = simulate_experiment(
      study, draw_of(OtherFaultKind::held_mv, 1, kNaN, {.sample = 40}), testing::kFactory);
  REQUIRE(held.status == ControlStatus::ok);
  CHECK((held.u.row(1).tail(80).array() == healthy.u(1, 39)).all());
  CHECK(held.u.leftCols(40) == healthy.u.leftCols(40));
  const Trajectory stuck =
      simulate_experiment(study, draw_of(OtherFaultKind::stiction, 1, 0.05), testing::kFactory);
  REQUIRE(stuck.status == ControlStatus::ok);
  CHECK(stuck.u(1, 20) != stuck.u(1, 19));
  CHECK((stuck.y - healthy.y).cwiseAbs().maxCoeff() > 1e-3);
}

TEST_CASE(
    "other faults: a stuck sensor shows what it measured at the onset, and the controller believes it") {
  const Study study = range_study();
  const Trajectory healthy = simulate_experiment(study, basis_draw(), testing::kFactory);
  const Trajectory stuck = simulate_experiment(
      study, draw_of(OtherFaultKind::sensor_stuck, 0, kNaN, {.sample = 40}), testing::kFactory);
  REQUIRE(stuck.samples_done > 60);
  const Eigen::Index rest = stuck.samples_done - 40;
  CHECK(stuck.y.leftCols(41) == healthy.y.leftCols(41));
  CHECK((stuck.y.row(0).segment(40, rest).array() == healthy.y(0, 40)).all());
  CHECK(stuck.u.middleCols(41, rest - 1) != healthy.u.middleCols(41, rest - 1));
}

TEST_CASE("other faults: a changed limit moves the CV that rests on it") {
  const Study study = range_study();
  const Trajectory healthy = simulate_experiment(study, basis_draw(), testing::kFactory);
  // y1 of chapter 6 rides on its upper limit; inwards by 0.2.
  const Trajectory shifted =
      simulate_experiment(study, draw_of(OtherFaultKind::limit, 0, -0.2, {.sample = 30}), testing::kFactory);
  REQUIRE(shifted.status == ControlStatus::ok);
  CHECK(shifted.y.leftCols(30) == healthy.y.leftCols(30));
  // By half: the optimizer trades the limit against the targets of the MVs, and the MDs step in between.
  CHECK((shifted.y - healthy.y).rightCols(60).row(0).mean() == Approx(-0.2).epsilon(0.5));
}

TEST_CASE("other faults: what a loop cannot have is never drawn, everything else is") {
  Study study = find_study("chapter6");
  study.experiments = {.other = 1};
  std::array<int, kOtherFaultKinds.size()> count{};
  for (std::int64_t i = 0; i < 400; ++i) {
    const ExperimentDraw draw = draw_experiment(study, i);
    REQUIRE(draw.other);
    ++count[static_cast<std::size_t>(draw.other->kind)];
    CHECK_FALSE(draw.affected().empty());
    CHECK(draw.affected().front().by == FaultSource::none);
  }
  // Those that came later are for studies that ask for them.
  CHECK(std::all_of(count.begin(), count.begin() + 8, [](int n) { return n > 25; }));
  CHECK(std::all_of(count.begin() + 8, count.end(), [](int n) { return n == 0; }));
  study.other.weight.fill(1.0);
  for (std::int64_t i = 0; i < 600; ++i)
    ++count[static_cast<std::size_t>(draw_experiment(study, i).other->kind)];
  CHECK(std::all_of(count.begin() + 8, count.end(), [](int n) { return n > 25; }));
  Study setpoints = find_study("setpoint-methods");  // neither MDs nor soft limits
  const auto weights = other_weights(setpoints);
  for (const OtherFaultKind kind : {OtherFaultKind::md_gain, OtherFaultKind::md_noise, OtherFaultKind::limit})
    CHECK(weights[static_cast<std::size_t>(kind)] == 0.0);
}

TEST_CASE("other faults: each is about a sensor, a valve or something else, and told so", "[other]") {
  for (const OtherFaultKind kind : kOtherFaultKinds) {
    const OtherFaultInfo& info = info_of(kind);
    const ToldSource told = told_source(OtherFault{kind, 0});
    INFO(to_string(kind));
    CHECK((told == ToldSource::valve) == (info.stem != nullptr));
    CHECK((told == ToldSource::other) == (kind == OtherFaultKind::limit || kind == OtherFaultKind::held_mv));
    CHECK(source_of(told) == FaultSource::other);
  }
  for (const FaultSource source : enumerators<FaultSource>())
    CHECK(to_string(told_source(source)) == to_string(source));
}

}  // namespace
