#include <algorithm>
#include <cmath>
#include <map>

#include <catch2/catch.hpp>

#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"
#include "scenarios/loop/draw.hpp"
#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/loop/kind_sequence.hpp"

namespace {

using namespace mpm;

TEST_CASE("KindSequence: every beginning keeps the proportions, every period the counts") {
  const KindSequence sequence({150, 150, 100});
  std::map<ExperimentKind, int> count;
  for (int i = 0; i < 400; ++i) {
    ++count[sequence[i]];
    // The greedy rule keeps each kind within one experiment of its share.
    CHECK(std::abs(count[ExperimentKind::mpm] - 0.375 * (i + 1)) <= 1.0);
    CHECK(std::abs(count[ExperimentKind::ud] - 0.375 * (i + 1)) <= 1.0);
    CHECK(std::abs(count[ExperimentKind::mpm_ud] - 0.25 * (i + 1)) <= 1.0);
  }
  CHECK(count[ExperimentKind::mpm] == 150);
  CHECK(count[ExperimentKind::ud] == 150);
  CHECK(count[ExperimentKind::mpm_ud] == 100);
}

TEST_CASE("KindSequence refuses counts that make no study") {
  CHECK_THROWS_AS(KindSequence({0, 0, 0}), InputError);
  CHECK_THROWS_AS(KindSequence({-1, 2, 0}), InputError);
}

TEST_CASE("draw_experiment: values lie in the ranges of table 6.4 and cover the channels") {
  const Study study = find_study("chapter6");
  std::map<std::pair<Eigen::Index, Eigen::Index>, int> channels;
  for (std::int64_t i = 0; i < 2000; ++i) {
    const ExperimentDraw draw = draw_experiment(study, i);
    CHECK(draw.mismatches.size() == (draw.kind != ExperimentKind::ud ? 1 : 0));
    CHECK(draw.disturbances.size() == (draw.kind != ExperimentKind::mpm ? 1 : 0));
    CHECK_FALSE(draw.named);
    REQUIRE(draw.affected().size() == 1);
    CHECK(draw.affected().front().cv == draw.true_cv());
    CHECK(draw.affected().front().by == source_of(draw.kind));
    for (const Disturbance& disturbance : draw.disturbances) {
      CHECK((disturbance.gain >= 0.1 && disturbance.gain <= 3.0));
      CHECK((disturbance.time_constant >= 30 && disturbance.time_constant <= 300));
    }
    if (draw.mismatches.empty())
      continue;
    const Mismatch& m = draw.mismatches.front();
    ++channels[{m.cv, m.input}];
    const double dead_time = study.plant.G(m.cv, m.input).dead_time();
    switch (m.parameter) {
      case MismatchParameter::gain:
        CHECK((m.value >= 0.3 && m.value <= 1.5));
        break;
      case MismatchParameter::time_constant:
        CHECK((m.value >= 0.3 && m.value <= 3.0));
        break;
      case MismatchParameter::dead_time:
        CHECK((m.value >= std::max(-2.0, -dead_time) && m.value <= 2.0));
        break;
      case MismatchParameter::second_order:
      case MismatchParameter::inverse_response:
      case MismatchParameter::sign:
      case MismatchParameter::channel:
        FAIL("a random draw never replaces a channel");
    }
    const TransferFunction changed = with_mismatches(study.plant.G, {m})(m.cv, m.input);
    CHECK(changed.dead_time() >= 0.0);
  }
  CHECK(channels.size() == 21);  // 7 CVs x 3 MVs; each is missed with probability (20/21)^1250
}

TEST_CASE("draw_experiment: a draw depends on seed and index only") {
  Study study = find_study("chapter6");
  const ExperimentDraw late = draw_experiment(study, 7);
  (void)draw_experiment(study, 3);
  const ExperimentDraw again = draw_experiment(study, 7);
  REQUIRE(late.mismatches.size() == again.mismatches.size());
  if (!late.mismatches.empty())
    CHECK(late.mismatches.front().value == again.mismatches.front().value);
  study.seed += 1;
  const ExperimentDraw other = draw_experiment(study, 6);
  study.seed -= 1;
  const ExperimentDraw same = draw_experiment(study, 6);
  REQUIRE(other.kind == same.kind);
  if (!same.mismatches.empty())
    CHECK(other.mismatches.front().value != same.mismatches.front().value);
  if (!same.disturbances.empty())
    CHECK(other.disturbances.front().gain != same.disturbances.front().gain);
  CHECK_THROWS_AS(draw_experiment(study, -1), InputError);
}

TEST_CASE("with_mismatches changes the named parameter of the named channel alone") {
  const Study study = find_study("chapter6");
  const TransferMatrix& G = study.plant.G;
  const TransferMatrix gain = with_mismatches(G, {{1, 2, MismatchParameter::gain, 0.5}});
  CHECK(gain(1, 2).static_gain() == Approx(0.5 * G(1, 2).static_gain()));
  const TransferMatrix time = with_mismatches(G, {{1, 2, MismatchParameter::time_constant, 2.0}});
  CHECK(time(1, 2).static_gain() == Approx(G(1, 2).static_gain()));
  CHECK(std::abs(time(1, 2)({0.0, 0.01})) == Approx(std::abs(G(1, 2)({0.0, 0.02}))));
  const TransferMatrix delay = with_mismatches(G, {{1, 2, MismatchParameter::dead_time, 1.5}});
  CHECK(delay(1, 2).dead_time() == Approx(G(1, 2).dead_time() + 1.5));
  for (const TransferMatrix* changed : {&gain, &time, &delay})
    for (Eigen::Index i = 0; i < G.rows(); ++i)
      for (Eigen::Index j = 0; j < G.cols(); ++j)
        if (i != 1 || j != 2)
          CHECK((*changed)(i, j)({0.0, 0.03}) == G(i, j)({0.0, 0.03}));
}

}  // namespace
