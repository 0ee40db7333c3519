#include <catch2/catch.hpp>

#include "analysis/findings/leaderboard.hpp"
#include "analysis/findings/source_confusions.hpp"
#include "analysis/findings/source_forecast.hpp"
#include "analysis/methods/source_probabilities.hpp"

// What is taken for what, and what stated probabilities are held against.

namespace mpm {
namespace {

constexpr OutcomeScope kTells{.tells_sources = true, .is_told = true};

/// One of each truth, and one that nobody has looked at.
LoopTruths every_truth() {
  LoopTruths truths{FaultTruth{},
                    FaultTruth{ExperimentKind::tuning},
                    FaultTruth{ExperimentKind::mpm, true, true},
                    FaultTruth{ExperimentKind::ud},
                    FaultTruth{ExperimentKind::mpm_ud},
                    FaultTruth{.kind = ExperimentKind::other, .about = ToldSource::sensor},
                    FaultTruth{.kind = ExperimentKind::other, .about = ToldSource::valve},
                    FaultTruth{.kind = ExperimentKind::other},
                    std::nullopt};
  return truths;
}

CellScores cell_with(const LoopTruths& truths, const LoopOutcome& said, const OutcomeScope& scope) {
  CellScores cell{.experiments = static_cast<std::int64_t>(truths.size()),
                  .truths = truths,
                  .worlds = std::vector<int>(truths.size(), 0)};
  LoopOutcomes outcomes(truths.size(), said);
  outcomes.back().reset();
  cell.methods.push_back(scores_of_outcomes(cell, outcomes, scope));
  return cell;
}

Leaderboard board_with(const std::vector<CellScores>& cells) {
  Suite suite;
  suite.name = "s";
  suite.plants = {{"a", ""}};
  suite.families = {{"f", ""}};
  return make_leaderboard(suite, {"m"}, "1.0", cells);
}

}  // namespace

TEST_CASE("confusions: every loop counts once, whatever is true of it and whatever is answered",
          "[confusions]") {
  const LoopTruths truths = every_truth();
  LoopOutcomes answers{LoopOutcome{}, LoopOutcome{.answered = true},
                       LoopOutcome{.answered = true, .told = ToldSource::mpm}};
  for (const ToldSource told : enumerators<ToldSource>())
    answers.push_back(LoopOutcome{.answered = true, .flagged = true, .told = told});
  SourceConfusions all;
  for (const std::optional<LoopOutcome>& said : answers) {
    const Leaderboard board = board_with({cell_with(truths, *said, kTells)});
    const SourceConfusions& found = board.overall[0].confusions;
    CHECK(found.total() == static_cast<std::int64_t>(truths.size()) - 1);
    CHECK(found.total() == board.overall[0]["answered"].total);
    CHECK(found.of(answered_source(*said)) == found.total());
    all.add(found);
  }
  CHECK(all.total() == static_cast<std::int64_t>(answers.size() * (truths.size() - 1)));
  CHECK(all.of(ToldSource::none) == static_cast<std::int64_t>(2 * answers.size()));  // healthy, badly tuned
  CHECK(all.of(ToldSource::valve, AnsweredSource::sensor) == 1);
  CHECK(all.of(ToldSource::sensor, right_answer(ToldSource::sensor)) == 1);
  CHECK(all.of(ToldSource::mpm, AnsweredSource::no_answer) == 1);
  CHECK(all.of(ToldSource::mpm, AnsweredSource::none) == 2);  // what it would name does not count
  CHECK(all.of(ToldSource::mpm, AnsweredSource::unnamed) == 1);
  for (const ToldSource truth : enumerators<ToldSource>())
    CHECK((truth == ToldSource::none ? "none" : to_string(truth)) == to_string(right_answer(truth)));
}

TEST_CASE("confusions: boards that do not keep the source that is named have none", "[confusions]") {
  const LoopOutcome said{.answered = true, .flagged = true};
  CHECK(board_with({cell_with(every_truth(), said, {.tells_sources = true, .is_whole = true})})
            .overall[0]
            .confusions.total() == 0);
}

TEST_CASE("outcomes: a source is told of methods that tell it, and agrees with what is right about it",
          "[confusions]") {
  const FaultTruth mismatch{ExperimentKind::mpm};
  const LoopOutcome right{
      .answered = true, .flagged = true, .right_source = true, .names_source = true, .told = ToldSource::mpm};
  CHECK(is_possible(right, mismatch, kTells));
  CHECK_FALSE(is_possible(right, mismatch, {.is_told = true}));
  CHECK_FALSE(is_possible(right, FaultTruth{ExperimentKind::ud}, kTells));
  LoopOutcome wrong = right;
  wrong.told = ToldSource::ud;
  CHECK_FALSE(is_possible(wrong, mismatch, kTells));
  wrong.right_source = false;
  CHECK(is_possible(wrong, mismatch, kTells));
  const FaultTruth valve{.kind = ExperimentKind::other, .about = ToldSource::valve};
  wrong.right_source = true;
  wrong.told = ToldSource::sensor;
  CHECK(is_possible(wrong, valve, kTells));  // of another fault any of its names is the right source
}

TEST_CASE("forecast: stating the frequencies has no skill, and the truth all of it", "[probabilities]") {
  // Of eight loops two are without a fault, three have another one, and of each other kind there is one.
  CellScores cell = cell_with(every_truth(), {.answered = true}, kTells);
  const SourceProbabilities frequencies = *source_frequencies(board_with({cell}));
  CHECK(frequencies == SourceProbabilities{0.25, 0.125, 0.125, 0.125, 0.375});
  const auto skill_of = [&](auto stated) {
    WorldMean log, brier;
    Reliability reliability;
    for (const std::optional<FaultTruth>& truth : cell.truths)
      if (truth) {
        const FaultSource source = source_of(truth->kind);
        log.add(0, log_score(stated(source), source));
        brier.add(0, brier_score(stated(source), source));
        reliability.add(stated(source), source);
      }
    CellScores with = cell;
    with.methods[0].estimates["log_score"] = log.mean(0.95);
    with.methods[0].estimates["brier_score"] = brier.mean(0.95);
    with.methods[0].reliability = reliability;
    const Leaderboard board = board_with({with, with});  // pooled over cells
    CHECK(states_probabilities(board, 0));
    CHECK(board.overall[0].estimates["calibration_error"].value == Approx(reliability.error()));
    CHECK(board.overall[0].estimates["calibration_error"].count == 16);
    return forecast_skill(board, 0);
  };
  const ForecastSkill of_frequencies = skill_of([&](FaultSource) { return frequencies; });
  CHECK(of_frequencies.log_score == Approx(0.0).margin(1e-12));
  CHECK(of_frequencies.brier_score == Approx(0.0).margin(1e-12));
  const ForecastSkill of_truth = skill_of([](FaultSource truth) {
    SourceProbabilities sure{};
    sure[static_cast<std::size_t>(truth)] = 1.0;
    return sure;
  });
  CHECK(of_truth.log_score == 1.0);
  CHECK(of_truth.brier_score == 1.0);
  CHECK(skill_of([](FaultSource) { return SourceProbabilities{0, 1, 0, 0, 0}; }).log_score < 0.0);
  CHECK_FALSE(source_frequencies(board_with({})));
}

}  // namespace mpm
