// The active-set method and DAQP on the same programs, in turn: the table of docs/performance.md, "Kernels".

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "analysis/study_files/study_library.hpp"
#include "bench/perf/daqp_rival.hpp"
#include "bench/perf/qp_timing.hpp"
#include "solvers/lanes/kernel_choice.hpp"
#include "solvers/qp_solver_factory.hpp"

namespace mpm {
namespace {

struct RaceOptions {
  int rounds = 5;
  int passes = 5;
  std::string filter;
};

/// Times DAQP's passes over a sequence, as QpTiming does.
class DaqpTiming {
 public:
  explicit DaqpTiming(const QpSequence& sequence)
      : sequence_(sequence), rival_(*sequence.structure), microseconds_(sequence.data.size()) {}

  /// Solves all programs once.
  void pass() {
    rival_.reset();
    for (std::size_t k = 0; k < sequence_.data.size(); ++k)
      microseconds_[k].push_back(1e6 * rival_.solve(sequence_.data[k]));
  }
  QpTimes times() const { return program_times(microseconds_); }

 private:
  const QpSequence& sequence_;
  DaqpRival rival_;
  std::vector<std::vector<double>> microseconds_;
};

/// The largest difference of a move between both solvers' answers, and how many programs only one solved.
struct Agreement {
  double difference = 0.0;
  int only_one = 0;
};

Agreement compare_answers(const QpSequence& sequence) {
  Agreement result;
  DaqpRival rival(*sequence.structure);
  const auto ours = qp_solver_factory("active-set")(sequence.structure);
  for (const QpData& data : sequence.data) {
    rival.solve(data);
    const QpResult& answer = ours->solve(data);
    if ((answer.status == QpStatus::solved) != rival.solved())
      ++result.only_one;
    else if (rival.solved())
      result.difference = std::max(result.difference, (answer.x - rival.x()).cwiseAbs().maxCoeff());
  }
  return result;
}

/// The text "median (least to largest)" of the values of the rounds.
std::string spread(std::vector<double> values, const char* format) {
  std::sort(values.begin(), values.end());
  const auto text = [&](double value) { return fmt::format(fmt::runtime(format), value); };
  return fmt::format("{} ({} to {})", text(values[values.size() / 2]), text(values.front()),
                     text(values.back()));
}

void race(const QpSequence& sequence, const RaceOptions& options) {
  std::vector<double> median, p99, ratio, ratio_p99;
  for (int round = 0; round < options.rounds; ++round) {
    QpTiming ours(sequence, qp_solver_factory("active-set"), StartOfSolve::warm);
    DaqpTiming theirs(sequence);
    for (int pass = 0; pass < options.passes; ++pass) {
      ours.pass();
      theirs.pass();
    }
    median.push_back(ours.times().median);
    p99.push_back(ours.times().p99);
    ratio.push_back(theirs.times().median / ours.times().median);
    ratio_p99.push_back(theirs.times().p99 / ours.times().p99);
  }
  const Agreement agreement = compare_answers(sequence);
  fmt::print("| {} / {} | {} | {} | {} | {} | {:.0e} | {} |\n", sequence.slack, sequence.loop,
             spread(median, "{:.1f}"), spread(p99, "{:.0f}"), spread(ratio, "{:.2f}"),
             spread(ratio_p99, "{:.1f}"), agreement.difference, agreement.only_one);
  std::fflush(stdout);
}

int run(int argc, char** argv) {
  CLI::App app("Times the active-set method against DAQP (docs/performance.md).", "mpmbench_race");
  RaceOptions options;
  app.add_option("--rounds", options.rounds, "rounds, of which the spread is shown")
      ->check(CLI::PositiveNumber);
  app.add_option("--passes", options.passes, "passes of each solver in a round")->check(CLI::PositiveNumber);
  app.add_option("--filter", options.filter, "only loops whose name contains this (per-cv/ud)");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  fmt::print(
      "Kernels: {}. DAQP: {}. Ours in us, ratios DAQP / ours, {} rounds of {} passes, least to largest.\n\n",
      lane_kernels().name, MPMBENCH_DAQP_FLAGS, options.rounds, options.passes);
  fmt::print(
      "| loop | median | p99 | ratio of medians | ratio of p99 | largest difference of a move | only one "
      "solved |\n"
      "|---|---:|---:|---:|---:|---:|---:|\n");
  for (const QpSequence& sequence : recorded_sequences(find_study("chapter6")))
    if (sequence.problem == "moves" && sequence.name().find(options.filter) != std::string::npos)
      race(sequence, options);
  return 0;
}

}  // namespace
}  // namespace mpm

int main(int argc, char** argv) {
  try {
    return mpm::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mpmbench_race: %s\n", error.what());
    return 2;
  }
}
