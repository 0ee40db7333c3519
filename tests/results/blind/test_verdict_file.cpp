#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"
#include "results/blind/blind_loops.hpp"
#include "results/blind/verdict_file.hpp"
#include "solvers/qp_solver_factory.hpp"
#include "tests/results/made_up_campaign.hpp"

// Files of verdicts: every line comes to the loop or the window that it is of, and what is no verdict is
// refused by file, line and column.

namespace mpm::testing {
namespace {

/// Five experiments of chapter 6, one of them infeasible, with two calibration loops and three windows a
/// loop.
Campaign five_loops() {
  Campaign campaign;
  campaign.study = find_study("chapter6");
  campaign.study.simulation.samples = 20;
  campaign.study.monitoring = MonitoringOptions{.window = 10, .stride = 5};
  campaign.study.calibration = CalibrationOptions{};
  campaign.study.record.candidates = 2;
  for (int index = 0; index < 5; ++index) {
    ExperimentRecord record;
    record.draw.index = index;
    record.status = index == 3 ? ExperimentStatus::infeasible : ExperimentStatus::ok;
    record.ivar_basis = Eigen::VectorXd::Constant(7, 1.0 + index);
    campaign.records.push_back(record);
  }
  campaign.calibration.seed = 77;
  campaign.calibration.loops.assign(2, {ExperimentKind::healthy, {}});
  return campaign;
}

OutsideVerdicts verdicts_in(const Campaign& campaign, const std::string& text) {
  const TemporaryFolder folder;
  make_file(folder / "mine.csv", text);
  return read_verdicts(folder / "mine.csv", "mine", campaign);
}

/// What is refused of the file, from the name of the file on.
std::string refusal_of(const std::string& text) {
  try {
    verdicts_in(five_loops(), text);
    return "accepted";
  } catch (const InputError& error) {
    const std::string said = error.what();
    return said.substr(said.find("mine.csv"));
  }
}

/// The file with this heading and these lines on the loops of the campaign.
std::string with_hash(bool with_calibration, const std::string& lines) {
  return hash_line(loops_hash(five_loops(), with_calibration)) + lines;
}

}  // namespace

TEST_CASE("blind order: without calibration loops every loop that ran, with them they are among the others") {
  const Campaign campaign = five_loops();
  std::vector<bool> seen(5, false);
  const std::vector<BlindLoop> order = blind_order(campaign, false);
  REQUIRE(order.size() == 4);
  for (const BlindLoop& loop : order) {
    CHECK_FALSE(loop.of_calibration);
    seen[loop.place] = true;
  }
  CHECK(seen == std::vector<bool>{true, true, true, false, true});

  const std::vector<BlindLoop> all = blind_order(campaign, true);
  REQUIRE(all.size() == 6);
  std::vector<bool> calibration(2, false);
  for (const BlindLoop& loop : all)
    if (loop.of_calibration)
      calibration[loop.place] = true;
  CHECK(calibration == std::vector<bool>{true, true});
  CHECK(loops_hash(campaign, false) != loops_hash(campaign, true));

  const Campaign streamed = streamed_from(campaign);
  CHECK(loops_hash(streamed, true) == loops_hash(campaign, true));
  CHECK(blind_key(streamed, true) == blind_key(campaign, true));
  CHECK(verdicts_in(streamed, "loop,flagged\n0,1\n").answers.size() == 5);
}

TEST_CASE("blind loops: one that did not run to its end is missing throughout, the others are as they were") {
  Campaign campaign = made_up_campaign();
  const auto loop_of = [&](double value) {
    AssessedLoop loop;
    for (const LoopSignal& signal : loop_signals())
      loop.*signal.member = Eigen::MatrixXd::Constant(std::ssize(row_names(campaign.study, signal)),
                                                      campaign.study.simulation.samples, value);
    return loop;
  };
  const BlindLoops loops{3, [&]() -> BlindLoops::Next {
                           return [&, number = 0]() mutable {
                             return number++ == 1 ? AssessedLoop() : loop_of(number);
                           };
                         }};
  const TemporaryFolder folder;
  write_blind_loops(folder.path(), campaign,
                    {campaign.study, campaign.basis, qp_solver_factory("active-set")}, {loops}, {});
  const std::string text = file_content(folder / "loops.csv");
  const auto rows = [&](const std::string& start, const std::string& value) {
    int count = 0;
    for (std::size_t at = text.find("\n" + start); at != std::string::npos;
         at = text.find("\n" + start, at + 1)) {
      const std::string row = text.substr(at, text.find('\n', at + 1) - at);
      count += row.substr(row.rfind(',') + 1) == value ? 1 : 0;
    }
    return count;
  };
  CHECK(rows("0,", "1") == campaign.study.simulation.samples);
  CHECK(rows("1,", "NaN") == campaign.study.simulation.samples);
  CHECK(rows("2,", "3") == campaign.study.simulation.samples);
}

TEST_CASE("verdict file: each line is kept with the record of its loop; one without a line has failed") {
  const Campaign campaign = five_loops();
  const OutsideVerdicts read =
      verdicts_in(campaign, with_hash(false,
                                      "loop,flagged,score,cv,source,channels,parameter,size,candidate,error\n"
                                      "2,yes,7.5,y3,valve,y3/u1 y1/u2,gain,1.25,2,\n"
                                      "# a comment, and an empty line\n\n"
                                      "0,0,-inf,,,,,,,\n"
                                      "1,,,,,,,,,\"no, \"\"not\"\" this one\"\n"));
  CHECK(read.says_which_loops);
  const MethodDescription& method = read.form->method();
  CHECK((method.locates_cvs && method.tells_sources && method.names_channels && method.names_mismatches &&
         method.names_candidates));
  CHECK(method.origin == "file of verdicts mine.csv");
  const std::vector<BlindLoop> order = blind_order(campaign, false);
  const auto answer = [&](std::size_t loop) { return read.answers[order[loop].place]; };
  CHECK((answer(2).flagged && answer(2).score == 7.5 && answer(2).predicted_cv == 2));
  CHECK(answer(2).predicted_source == FaultSource::other);
  CHECK(answer(2).told() == ToldSource::valve);
  CHECK((answer(2).names({2, 0}) && answer(2).names({0, 1}) && !answer(2).names({0, 0})));
  CHECK(answer(2).named_mismatch()->size == 1.25);
  CHECK(answer(2).number("named_candidate") == 1.0);  // numbers in files begin with 1, positions with 0
  CHECK((answer(0).answered() && !answer(0).flagged && answer(0).score == -kInfinity));
  CHECK(std::isnan(answer(0).number("named_candidate")));
  CHECK(answer(1).status == AssessmentStatus::failed);
  CHECK(answer(1).reason == "no, \"not\" this one");
  CHECK(answer(3).reason == "the file of verdicts has no line for this loop");
  CHECK(read.answers[3].status == AssessmentStatus::not_assessed);  // infeasible: no loop of the export
}

TEST_CASE("verdict file: windows stand beside the loop that they are of, and count where it has a verdict") {
  const Campaign campaign = five_loops();
  const OutsideVerdicts read = verdicts_in(campaign, with_hash(false,
                                                               "loop,window,flagged,score\n"
                                                               "0,,0,1\n0,2,1,4\n0,0,0,\n0,1,,\n"
                                                               "1,0,1,5\n"));
  const std::vector<BlindLoop> order = blind_order(campaign, false);
  const AssessmentRecord& first = read.answers[order[0].place];
  CHECK(first.number("window_flagged", 0, 0) == 0.0);
  CHECK(std::isnan(first.number("window_flagged", 0, 1)));
  CHECK(first.number("window_flagged", 0, 2) == 1.0);
  CHECK(first.number("window_score", 0, 2) == 4.0);
  CHECK_FALSE(read.answers[order[1].place].answered());
}

TEST_CASE("verdict file: the hash says whether calibration loops are among the others") {
  const Campaign campaign = five_loops();
  std::string lines = "loop,flagged,score\n";
  for (int loop = 0; loop < 6; ++loop)
    lines += fmt::format("{},0,{}\n", loop, 10 + loop);
  const OutsideVerdicts read = verdicts_in(campaign, with_hash(true, lines));
  const std::vector<BlindLoop> order = blind_order(campaign, true);
  for (std::size_t loop = 0; loop < order.size(); ++loop)
    CHECK((order[loop].of_calibration
               ? read.calibration_scores[order[loop].place]
               : read.answers[order[loop].place].score) == 10.0 + static_cast<double>(loop));

  // Without them they have no score; a loop without a score but with a verdict is below every threshold.
  const OutsideVerdicts others = verdicts_in(campaign, with_hash(false, "loop,flagged\n0,1\n"));
  CHECK(others.calibration_scores.size() == 2);
  CHECK((std::isnan(others.calibration_scores[0]) && std::isnan(others.calibration_scores[1])));
}

TEST_CASE("verdict file: as spreadsheets and data frames write it") {
  const Campaign campaign = five_loops();
  const std::string plain =
      with_hash(false, "loop,flagged,score,cv\n0,1,1.5,y1\n1,0,nan,\n2,1,-inf,y2\n3,0,0.25,\n");
  const OutsideVerdicts right = verdicts_in(campaign, plain);
  const std::string hash = plain.substr(0, plain.find('\n'));
  for (const std::string& text :
       {"\xEF\xBB\xBF" + hash +
            "\r\nloop,flagged,score,cv\r\n0,True,1.5,y1\r\n1,FALSE,,\r\n2,YES,-inf,y2\r\n3,no,.25,\r\n",
        hash + ";;;\nloop;flagged;score;cv\n0;WAHR;1,5;y1\n1;FALSCH;;\n2;1,0;-inf;y2\n3;0,0;0,25;\n",
        hash + "\n,loop,flagged,score,cv\n0,0.0,1.0,1.5,y1\n1,1.0,0.0,NaN,y2\n2,2.0,1.0,-inf,y2\n3,3.0,0.0,0."
               "25,\n",
        hash + "\n\"loop\",\"flagged\",\"score\",\"cv\"\n\"0\",\"1\",1.5,\"y1\"\n# "
               "none\n1,0,,\n2,1,-inf,y2\n3,0,0.25,\n"}) {
    INFO(text);
    const OutsideVerdicts read = verdicts_in(campaign, text);
    CHECK(read.says_which_loops);
    for (std::size_t i = 0; i < right.answers.size(); ++i) {
      CHECK(read.answers[i].answered() == right.answers[i].answered());
      CHECK(read.answers[i].flagged == right.answers[i].flagged);
      CHECK((read.answers[i].score == right.answers[i].score ||
             (std::isnan(read.answers[i].score) && std::isnan(right.answers[i].score))));
    }
  }
}

TEST_CASE("verdict file: one rule for quotes, and bounds for what others write") {
  CHECK(refusal_of("loop,flagged,error\n0,,5\" pipe\n") == "accepted");
  CHECK_THAT(refusal_of("loop,flagged,error\n0,,\"open\n1,1,\n2,0,\"ok\"\n"),
             Catch::StartsWith("mine.csv:2: found a quote that is not closed on its line"));
  CHECK_THAT(refusal_of("loop,flagged\n" + std::string(5'000'000, '7') + ",1\n"),
             Catch::StartsWith("mine.csv:2: loop: found '777") && Catch::EndsWith("7'; allowed: 0 to 3"));
  CHECK(refusal_of("loop,flagged\n" + std::string(5'000'000, '7') + ",1\n").size() < 200);
  CHECK(refusal_of("loop,flagged," + std::string(5'000'000, 'x') + "\n0,1,1\n").size() < 200);
  const OutsideVerdicts read =
      verdicts_in(five_loops(), "loop,flagged,error\n0,," + std::string(5'000'000, 'x') + "\n");
  for (const AssessmentRecord& answer : read.answers)
    CHECK(answer.reason.size() < 2100);
}

TEST_CASE("verdict file: every kind of line that is no verdict is refused by line and column") {
  const std::string heading = "loop,window,flagged,score,cv,source,channels,parameter,candidate\n";
  const auto line = [&](const std::string& text) { return refusal_of(heading + text); };
  using Catch::StartsWith;
  CHECK(refusal_of("") == "mine.csv: found no line; allowed: a heading line and a line for each loop");
  CHECK_THAT(refusal_of("flagged\n"),
             StartsWith("mine.csv:1: found columns flagged; allowed: at least loop"));
  CHECK_THAT(refusal_of("loop\n"), StartsWith("mine.csv:1: found columns loop; allowed: at least loop"));
  CHECK_THAT(refusal_of("loop,flagged,tea\n"),
             StartsWith("mine.csv:1: found column 'tea'; allowed: each once"));
  CHECK_THAT(refusal_of("loop,flagged,flagged\n"),
             StartsWith("mine.csv:1: found column 'flagged'; allowed:"));
  CHECK_THAT(line("0,,1\n"), StartsWith("mine.csv:2: found 3 fields; allowed: 9"));
  CHECK_THAT(line("0,,\"1,,,,,,\n"), StartsWith("mine.csv:2: found a quote that is not closed"));
  CHECK_THAT(line(",,1,,,,,,\n"), StartsWith("mine.csv:2: loop: found ''; allowed: 0 to 3"));
  CHECK_THAT(line("4,,1,,,,,,\n"), StartsWith("mine.csv:2: loop: found '4'; allowed: 0 to 3"));
  CHECK_THAT(line("-1,,1,,,,,,\n"), StartsWith("mine.csv:2: loop: found '-1'; allowed: 0 to 3"));
  CHECK_THAT(line("1.5,,1,,,,,,\n"), StartsWith("mine.csv:2: loop: found '1.5'; allowed: 0 to 3"));
  CHECK_THAT(line("0,,1,,,,,,\n0,,1,,,,,,\n"), StartsWith("mine.csv:3: loop: found 0 twice; allowed: each"));
  CHECK_THAT(line("0,3,1,,,,,,\n"), StartsWith("mine.csv:2: window: found '3'; allowed: 0 to 2"));
  CHECK_THAT(line("0,1,1,,,,,,\n0,1,1,,,,,,\n"),
             StartsWith("mine.csv:3: loop: found 0 twice; allowed: each"));
  CHECK_THAT(line("0,,perhaps,,,,,,\n"), StartsWith("mine.csv:2: flagged: found 'perhaps'; allowed: 1, 0"));
  CHECK_THAT(line("0,,1,high,,,,,\n"), StartsWith("mine.csv:2: score: found 'high'; allowed: a number"));
  CHECK_THAT(line("0,,1,,y9,,,,\n"), StartsWith("mine.csv:2: cv: found \"y9\"; allowed: y1, y2"));
  CHECK_THAT(
      line("0,,1,,y1,tea,,,\n"),
      StartsWith(
          "mine.csv:2: source: found \"tea\"; allowed: none, mpm, ud, mpm_ud, other, sensor, valve, data"));
  CHECK_THAT(
      line("0,,1,,,mpm,,,\n"),
      StartsWith("mine.csv:2: source: found \"mpm\"; allowed: none, or a source together with its CV"));
  CHECK_THAT(line("0,,1,,,,y1,,\n"), StartsWith("mine.csv:2: channels: found 'y1'; allowed: channels CV/MV"));
  CHECK_THAT(line("0,,1,,,,y1/u9,,\n"), StartsWith("mine.csv:2: channels: found \"u9\"; allowed: u1"));
  CHECK_THAT(line("0,,1,,,,,gain,\n"), StartsWith("mine.csv:2: parameter: found 'gain'; allowed: nothing"));
  CHECK_THAT(line("0,,1,,,,y1/u1,tea,\n"), StartsWith("mine.csv:2: mismatch: found \"tea\"; allowed: gain"));
  CHECK_THAT(line("0,,1,,,,,,one\n"),
             StartsWith("mine.csv:2: candidate: found 'one'; allowed: the number of"));
  CHECK_THAT(line("0,,1,,,,,,0\n"), StartsWith("mine.csv:2: candidate: found 0; allowed: the number of"));
  CHECK_THAT(line("0,,1,,,,,,3\n"), StartsWith("mine.csv:2: candidate: found '3'; allowed: 1 to 2"));
  CHECK_THAT(
      refusal_of("# mpmbench loops sha256 0123\nloop,flagged\n0,1\n"),
      StartsWith("mine.csv: found verdicts on the loops 0123; allowed: verdicts on those of the archive"));
  CHECK_THAT(refusal_of("loop,flagged,cv,cv_flagged.y1\n0,1,y1,1\n"),
             StartsWith("mine.csv:2: cv: found \"y1\"; allowed: this or cv_flagged, not both"));
  CHECK(line("0,,1,2,y1,mpm,y1/u1,gain,1\n") == "accepted");
}

TEST_CASE(
    "verdict file: windows are refused where nobody watches any, and candidates where none are logged") {
  Campaign campaign = five_loops();
  campaign.study.monitoring.reset();
  campaign.study.record.candidates = 0;
  CHECK_THROWS_WITH(verdicts_in(campaign, "loop,window,flagged\n0,0,1\n"),
                    Catch::Contains("window: found '0'; allowed: nothing: the study does not monitor"));
  CHECK_THROWS_WITH(verdicts_in(campaign, "loop,flagged,candidate\n0,1,1\n"),
                    Catch::Contains("candidate: found '1'; allowed: nothing: the study logs no candidates"));
}

}  // namespace mpm::testing
