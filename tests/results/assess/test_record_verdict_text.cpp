#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/records/record_verdict.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/non_finite.hpp"
#include "results/assess/record_verdict_text.hpp"
#include "scenarios/random/random_stream.hpp"
#include "tests/base/thorough.hpp"

// Whatever the evidence, the sentences of a verdict do not contradict each other. They are judged as a reader
// judges them: by their words and numbers, without the verdict behind them.

namespace {

using namespace mpm;

/// Draws evidence, the odd and the extreme more often than a plant does.
class EvidenceDraw {
 public:
  EvidenceDraw(std::uint64_t seed, Eigen::Index cvs, Eigen::Index mvs)
      : stream_(seed, 0, StreamId::world), cvs_(cvs), mvs_(mvs) {}

  VerdictEvidence draw() {
    VerdictEvidence of;
    if (!chance(0.1)) {
      of.model_scores = Eigen::VectorXd(cvs_);
      for (double& score : of.model_scores)
        score = chance(0.1) ? kNaN : chance(0.1) ? 1.22 + 1e-9 * between(-1, 1) : between(0.5, 6.0);
      of.model_threshold = chance(0.05) ? kNaN : chance(0.1) ? 1.22 : between(1.0, 3.0);
    }
    if (chance(0.1))
      of.noisy.push_back({index(cvs_), between(10.1, 80.0), 10.0, true});
    of.least_visible = chance(0.2) ? kInfinity : between(0.0, 0.8);
    const bool has_trials = chance(0.8);
    for (Eigen::Index cv = 0; cv < cvs_; ++cv)
      of.costs.push_back({.cv = cv,
                          .has_setpoint = chance(0.5),
                          .ratio = chance(0.1)   ? kNaN
                                   : chance(0.1) ? 2797230.507
                                                 : between(0.3, 3.0),
                          .threshold = has_trials ? between(0.5, 2.5) : kNaN});
    if (has_trials) {
      TrialCounts counts;
      counts.above = static_cast<std::int64_t>(between(0, 200));
      counts.healthy_above = static_cast<std::int64_t>(between(0, 0.1) * static_cast<double>(counts.above));
      counts.below = static_cast<std::int64_t>(between(0, 200));
      counts.healthy_below = static_cast<std::int64_t>(between(0, 1) * static_cast<double>(counts.below));
      counts.same = static_cast<std::int64_t>(between(0, 1) * static_cast<double>(counts.above));
      counts.right = static_cast<std::int64_t>(between(0, 1.01) * static_cast<double>(counts.same));
      of.trials = counts;
    }
    if (chance(0.4))
      of.onset = FaultOnset{3, 2, 5};
    for (std::size_t place = 1; place < kRecordSources; ++place)
      of.weights.of.each[place] = chance(0.5) ? 0.0 : chance(0.3) ? 1.0 : between(0.0, 1.0);
    if (chance(0.3)) {  // by either cause
      of.weights.drift = between(0.0, 1.0);
      of.jumps = chance(0.5);
      of.weights.of[RecordSource::sensor] = of.weights.drift;
      of.weights.of[RecordSource::disturbance] += of.weights.drift;
    }
    if (chance(0.1)) {
      of.stuck = Standstill{1, 4, 0.0};
      of.weights = {};
      of.weights.of[RecordSource::sensor] = 1.0;
      of.sensor_cv = index(cvs_);
    }
    of.benchmark = {.use = static_cast<BenchmarkUse>(index(3)), .cv = index(cvs_), .is_wanted = chance(0.8)};
    if (chance(0.8) || of.benchmark.use != BenchmarkUse::none) {
      of.benchmark.first = 1;
      of.benchmark.end = 4;
      of.benchmark.channel_score = chance(0.2) ? kNaN : between(0.0, 6.0);
    }
    if (chance(0.7)) {
      const double size = between(0.3, 3.0);
      of.mismatch = NamedMismatch{{index(cvs_), index(mvs_)}, static_cast<MismatchParameter>(index(7))};
      if (chance(0.8))
        *of.mismatch = {of.mismatch->channel, of.mismatch->parameter,          size, size - 0.2,
                        size + 0.1,           static_cast<SizeBound>(index(3))};
    }
    if (chance(0.5))
      of.valve_mv = index(mvs_);
    if (chance(0.5))
      of.sensor_cv = index(cvs_);
    if (chance(0.7)) {
      const double gain = chance(0.2) ? between(-0.004, 0.004) : between(-0.5, 0.5);
      of.promise = PromisedGain{gain, gain - between(0, 0.1), gain + between(0, 0.1)};
      if (chance(0.8)) {
        of.promise->variance_ratio = Eigen::VectorXd(cvs_);
        for (double& ratio : of.promise->variance_ratio)
          ratio = between(0.5, 1.1);
      }
    }
    if (chance(0.5)) {
      of.late = chance(0.3) ? -1.0 : 0.5;
      if (chance(0.5))
        of.late_cvs = {index(cvs_)};
      of.late_is_corrected = chance(0.3);
    }
    of.tells_apart = chance(0.8);
    of.controller_is_alike = chance(0.8);
    return of;
  }

 private:
  double between(double lower, double upper) { return lower + (upper - lower) * stream_.uniform(); }
  bool chance(double share) { return stream_.uniform() < share; }
  Eigen::Index index(Eigen::Index count) {
    return std::min(count - 1, static_cast<Eigen::Index>(between(0, static_cast<double>(count))));
  }

  RandomStream stream_;
  Eigen::Index cvs_, mvs_;
};

/// What a reader takes from the text.
struct Reading {
  std::vector<std::string> contradictions;

  void demand(bool holds, const std::string& what) {
    if (!holds)
      contradictions.push_back(what);
  }
};

std::vector<std::smatch> matches_of(const std::string& text, const std::regex& form) {
  std::vector<std::smatch> all;
  for (std::sregex_iterator at(text.begin(), text.end(), form), end; at != end; ++at)
    all.push_back(*at);
  return all;
}

bool has(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

/// Does the sentence name the CV? Channels name theirs otherwise.
bool names(const std::string& sentence, const std::string& cv) {
  return std::regex_search(sentence, std::regex("(^|[^/A-Za-z0-9])" + cv + "([^/A-Za-z0-9]|$)"));
}

void read_scores(const RecordVerdictText& text, const std::vector<std::string>& cvs, Reading& reading) {
  const std::string blamed =
      std::regex_replace(text.model,
                         std::regex("(Most likely|Likeliest).*?(?=The model does not explain|$)|"
                                    "In the record .*?this is corrected\\."),
                         "");  // the source is another question, and so are the rows of a CV
  std::map<std::string, bool> above;
  bool all_below = false;
  for (const std::string& line : text.scores) {
    std::smatch found;
    REQUIRE(std::regex_match(
        line, found,
        std::regex("(.*): (?:score|noise) (\\S+), threshold (\\S+): (not explained|explained)\\.")));
    const bool is_above = std::stod(found[2]) > std::stod(found[3]);
    reading.demand(is_above == (found[4] == "not explained"), "a score and what is said of it: " + line);
    above[found[1]] = is_above;
    all_below = all_below || found[1] == "All CVs";
  }
  const bool blames = has(blamed, "no longer explains") || has(blamed, "does not explain");
  reading.demand(!(all_below && blames), "below the threshold, and a fault is named");
  for (const std::string& cv : cvs)
    reading.demand(blames && names(blamed, cv) ? above[cv] : !above[cv], "named exactly when above: " + cv);
}

void read_costs(const RecordVerdictText& text, Reading& reading) {
  bool is_dearer = false;
  double most = 0.0;
  std::string dearest;
  for (const std::string& line : text.costs) {
    std::smatch found;
    if (!std::regex_match(line, found,
                          std::regex("(.*): (\\S+) times, threshold (\\S+): (costs more|as designed)\\.")))
      continue;
    const double ratio = std::stod(found[2]), threshold = std::stod(found[3]);
    const bool says_so = found[4] == "costs more";
    reading.demand(says_so == (ratio > threshold && ratio > 1.0), "a cost and what is said of it: " + line);
    is_dearer = is_dearer || says_so;
    if (says_so && ratio > most) {
      most = ratio;
      dearest = found[1];
    }
  }
  reading.demand(has(text.loop, "It costs more") == is_dearer, "the loop and its CVs: " + text.loop);
  if (!is_dearer)
    return;
  reading.demand(std::regex_search(text.loop, std::regex("designed[^:]*(?:\\([^)]*\\))?: " + dearest + " ")),
                 "the dearest CV first: " + text.loop);
  std::smatch named;
  if (std::regex_search(text.model, named, std::regex("(?:no longer explains|does not explain) ([A-Za-z]+)")))
    reading.demand(named[1] == dearest || has(text.loop, dearest + " costs most, but the model explains it"),
                   "the CV that is named costs most, or why not");
}

void read_probabilities(const RecordVerdictText& text, Reading& reading) {
  double sum = 0.0, largest = 0.0;
  const auto parts = matches_of(text.probabilities, std::regex("([0-9.]+) %"));
  for (const std::smatch& part : parts) {
    const double share = std::stod(part[1]);
    reading.demand(share > 0.0 && share < 100.0, "certain: " + text.probabilities);
    sum += share;
    largest = std::max(largest, share);
  }
  if (std::smatch likely; std::regex_search(text.model, likely, std::regex("Most likely \\(([0-9]+) %"))) {
    const auto share_of = [&parts](RecordSource source) {
      return std::stod(parts[static_cast<std::size_t>(source)][1]);
    };
    const bool drifts = has(text.model, "by its sensor or by an unmeasured disturbance");
    const double said =
        drifts ? share_of(RecordSource::sensor) + share_of(RecordSource::disturbance) : largest;
    reading.demand(std::abs(std::stod(likely[1]) - said) <= 0.5 && said >= largest,
                   "the most likely, and a likelier one");
  }
  reading.demand(parts.empty() || (parts.size() == kRecordSources && std::abs(sum - 100.0) < 1e-9),
                 "probabilities that do not add up: " + text.probabilities);
  reading.demand(!std::regex_search(text.model, std::regex("\\((0|100) %\\)")), "certain: " + text.model);
}

void read_action(const RecordVerdictText& text, Reading& reading) {
  reading.demand(!text.action.empty(), "nothing to do, and not even that is said");
  const bool well = text.model == "The model explains the record." && has(text.loop, "It costs no more") &&
                    !has(text.loop, "not the one that ran");
  reading.demand((text.action == "Nothing.") == well,
                 "nothing to do exactly where nothing is wrong: " + text.action);
  std::smatch gain;
  const bool promises =
      std::regex_search(text.action, gain, std::regex("(-?[0-9]+) % \\((-?[0-9]+) to (-?[0-9]+) %\\)"));
  if (promises) {
    const int expected = std::stoi(gain[1]);
    reading.demand(std::stoi(gain[2]) <= expected && expected <= std::stoi(gain[3]),
                   "a gain beside its interval");
    reading.demand(has(text.action, "gain nothing") ? expected <= 0 : expected >= 0,
                   "a gain and what is said of it: " + text.action);
  }
  std::smatch changes;
  if (std::regex_search(text.action, changes, std::regex("costs: (.*)\\)")))
    reading.demand(promises && has(changes[1], " -"), "a gain, and no cost falls: " + text.action);
  if (std::smatch repaired; std::regex_search(text.action, repaired, std::regex("Repair (\\w+/\\w+)")))
    reading.demand(has(text.model, repaired[1]), "a repair of what is not wrong: " + text.action);
  reading.demand(!(has(text.model, "and not the model") && has(text.action, "Repair")),
                 "a repair, and not the model");
  reading.demand(!std::regex_search(text.model, std::regex("at (least|most) [0-9.]+ \\(")),
                 "a bound with an end");
}

void read_benchmark(const RecordVerdictText& text, const std::vector<std::string>& cvs, Reading& reading) {
  const std::string& said = text.benchmark;
  const bool explains = has(text.model, "The model explains the record.");
  const bool fails = has(text.model, "no longer explains") || has(text.model, "does not explain");
  reading.demand(!said.empty(), "no word on the benchmark");
  reading.demand(!has(said, "none is needed") || explains, "none is needed, and the model fails: " + said);
  reading.demand(!(has(said, "assess again") || has(said, "none was found")) || fails,
                 "a benchmark is sought, and the model does not fail: " + said);
  reading.demand(!(fails && said == "No benchmark is named."),
                 "no word on what it is worth without: " + said);
  if (has(said, "assess again"))
    reading.demand(has(said, "benchmark = [\"1\", \"3\"]"), "a period without its line: " + said);
  if (has(said, "is wrong"))
    reading.demand(std::any_of(cvs.begin(), cvs.end(), [&](const auto& cv) { return names(said, cv); }),
                   "a channel of no CV: " + said);
  reading.demand(!(has(text.model, "by its sensor or by") && has(text.action, "Repair")),
                 "a repair of a model that something drifts away from");
  reading.demand(!(has(text.model, "drifts away") && has(text.model, "disturbance that stays")) &&
                     !(has(text.model, "jumps away") && has(text.model, "disturbance that grows")),
                 "a CV that drifts and jumps: " + text.model);
  reading.demand(!(has(text.action, "Repair") && has(text.action, "take away 0 %")),
                 "a repair that brings nothing: " + text.action);
  reading.demand(!has(text.model, "is stuck") || has(text.action, "sensor"),
                 "a stuck sensor that nobody looks at");
}

Reading reading_of(const RecordVerdictText& text, const std::vector<std::string>& cvs) {
  Reading reading;
  read_scores(text, cvs, reading);
  read_costs(text, reading);
  read_probabilities(text, reading);
  read_action(text, reading);
  read_benchmark(text, cvs, reading);
  return reading;
}

TEST_CASE("record verdict: no sentence contradicts another, whatever the evidence", "[verdict]") {
  const Study study = find_study("wood-berry");
  const std::vector<std::string> stamps{"0", "1", "2", "3", "4", "5"};
  const std::vector<std::string> cvs{"xD", "xB"};
  EvidenceDraw evidence(66, study.cv_count(), study.mv_count());
  std::map<std::string, int> said;
  const int draws = testing::is_thorough() ? 50'000 : 5000;
  for (int draw = 0; draw < draws; ++draw) {
    const RecordVerdict verdict = record_verdict(evidence.draw());
    const RecordVerdictText text = record_verdict_text(verdict, study, stamps);
    const Reading reading = reading_of(text, cvs);
    if (!reading.contradictions.empty())
      FAIL(fmt::format("{}\nModel:  {}\nLoop:   {}\nAction: {}\n{}\n{}\n{}",
                       fmt::join(reading.contradictions, "\n"), text.model, text.loop, text.action,
                       fmt::join(text.scores, " "), fmt::join(text.costs, " "), text.probabilities));
    ++said[std::string(to_string(verdict.action.kind))];
    ++said[std::string(to_string(verdict.model.source))];
    ++said[verdict.found()];
    ++said["benchmark " + std::string(to_string(verdict.benchmark.use))];
    said["drift"] += verdict.model.drifts ? 1 : 0;
    said["stuck"] += verdict.model.stuck ? 1 : 0;
  }
  // Every answer was among them.
  for (const ActionKind kind : enumerators<ActionKind>())
    CHECK(said[std::string(to_string(kind))] > 20);
  for (const RecordSource source : enumerators<RecordSource>())
    CHECK(said[std::string(to_string(source))] > 20);
  for (const char* found : {"fault", "nothing", "none", "other_controller", "unexplained_cost"})
    CHECK(said[found] > 20);
  for (const BenchmarkUse use : enumerators<BenchmarkUse>())
    CHECK(said["benchmark " + std::string(to_string(use))] > 20);
  CHECK((said["drift"] > 20 && said["stuck"] > 20));
}

/// The text of a healthy record, with one sentence exchanged.
RecordVerdictText well() {
  return {
      .model = "The model explains the record.",
      .loop = "It costs no more than designed (xD 1.04 times, xB 1.01 times the loop as designed).",
      .action = "Nothing.",
      .benchmark = "No benchmark is named, and none is needed: the model explains the record without one.",
      .scores = {"All CVs: score 1.02, threshold 1.22: explained."},
      .costs = {"xD: 1.04 times, threshold 1.1: as designed.", "xB: 1.01 times, threshold 1.1: as designed."},
      .probabilities =
          "Probabilities: nothing 93.0 %, a 1.0 %, b 1.0 %, c 1.0 %, d 1.0 %, e 1.0 %, f 1.0 %, g 1.0 %."};
}

TEST_CASE("record verdict: the reader of the text above notices each contradiction", "[verdict]") {
  const std::vector<std::string> cvs{"xD", "xB"};
  const auto notices = [&cvs](const RecordVerdictText& text) {
    return !reading_of(text, cvs).contradictions.empty();
  };
  CHECK_FALSE(notices(well()));
  RecordVerdictText text = well();
  text.scores = {"xD: score 9.37, threshold 1.22: not explained."};  // silent where its own check speaks
  CHECK(notices(text));
  text = well();
  text.model =
      "The model no longer explains xD. Likeliest: an unmeasured disturbance on xD, and not the model.";
  CHECK(notices(text));
  text = well();
  text.probabilities = "Probabilities: nothing 93.0 %, a 100.0 %.";
  CHECK(notices(text));
  text = well();
  text.costs[0] = "xD: 1.46 times, threshold 1.1: costs more.";  // and nothing to do
  CHECK(notices(text));
  text = well();
  text.costs[0] = "xD: 0.9 times, threshold 0.8: costs more.";  // a variance that fell
  CHECK(notices(text));
  text = well();
  text.action = "";
  CHECK(notices(text));
  text = well();
  text.action = "Wait: leave xD/R as it is, its repair is expected to gain nothing (11 % (5 to 12 %)).";
  CHECK(notices(text));
  text = well();
  text.model = "The model explains the record. at least 10.8 (10 to 11)";
  CHECK(notices(text));
  text = well();
  text.benchmark = "No benchmark is named: put benchmark = [\"1\", \"3\"] into [data] and assess again.";
  CHECK(notices(text));
  text.benchmark = "";
  CHECK(notices(text));
}

TEST_CASE("record verdict: with few simulated records nothing is certain", "[verdict]") {
  VerdictEvidence evidence;
  evidence.model_scores = Eigen::Vector2d(9.0, 1.0);
  evidence.model_threshold = 1.2;
  evidence.weights.of[RecordSource::valve] = 1.0;
  evidence.trials = TrialCounts{};
  const RecordVerdict none = record_verdict(evidence);
  CHECK((*none.model.probabilities)[RecordSource::valve] < 0.5);
  evidence.trials = TrialCounts{
      .healthy_above = 0, .above = 98, .healthy_below = 100, .below = 102, .right = 98, .same = 98};
  const RecordVerdict many = record_verdict(evidence);
  CHECK((*many.model.probabilities)[RecordSource::valve] == Approx(0.99 * (0.99 + 0.01 / 7.0)));
  CHECK((*many.model.probabilities)[RecordSource::nothing] == Approx(0.01));
}

TEST_CASE("record verdict: numbers on two sides of a threshold are printed apart", "[verdict]") {
  CHECK(told_apart(9.371, 1.224) == std::pair<std::string, std::string>{"9.37", "1.22"});
  CHECK(told_apart(1.2201, 1.22) == std::pair<std::string, std::string>{"1.2201", "1.22"});
  CHECK(told_apart(2797230.507, 1.0).first == "2797231");
}

}  // namespace
