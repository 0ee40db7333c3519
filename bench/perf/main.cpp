#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <benchmark/benchmark.h>

#include "analysis/study_files/study_library.hpp"
#include "bench/perf/benchmarks.hpp"
#include "bench/perf/octave_file.hpp"
#include "bench/version.hpp"

namespace {

struct PerfOptions {
  std::string export_folder;  ///< not empty: write the programs there and measure nothing
  std::int64_t experiments = 20;
  std::vector<std::string> rest;  ///< for Google Benchmark
};

PerfOptions parse(CLI::App& app, int argc, char** argv) {
  PerfOptions options;
  app.add_option("--export", options.export_folder, "write the paired programs for Octave into this folder");
  app.add_option("--experiments", options.experiments, "experiments of the study benchmark");
  app.allow_extras();
  app.footer(
      "Options of Google Benchmark are taken too: --benchmark_filter=REGEX, --benchmark_out=FILE, ...");
  app.parse(argc, argv);
  options.rest = app.remaining();
  return options;
}

void export_programs(const std::filesystem::path& folder, const std::vector<mpm::QpSequence>& sequences) {
  for (const mpm::QpSequence& sequence : sequences)
    if (sequence.problem == "moves")
      mpm::write_octave_file(folder / (sequence.slack + "-" + sequence.loop + ".txt"),
                             sequence.part(mpm::kPairedFirst, mpm::kPairedCount));
}

int measure(std::string program, std::vector<std::string> rest) {
  std::vector<char*> words{program.data()};
  for (std::string& word : rest)
    words.push_back(word.data());
  auto count = static_cast<int>(words.size());
  benchmark::Initialize(&count, words.data());
  if (benchmark::ReportUnrecognizedArguments(count, words.data()))
    return 2;
  benchmark::AddCustomContext("source", std::string(mpm::source_revision()));
  const char* threads = std::getenv("OPENBLAS_NUM_THREADS");
  benchmark::AddCustomContext("OPENBLAS_NUM_THREADS", threads != nullptr ? threads : "unset");
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

int run(int argc, char** argv) {
  CLI::App app("Measures how long the parts of a study take (docs/performance.md).", "mpmbench_perf");
  PerfOptions options;
  try {
    options = parse(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  const mpm::Study study = mpm::find_study("chapter6");
  const std::vector<mpm::QpSequence> sequences = mpm::recorded_sequences(study);
  if (!options.export_folder.empty()) {
    export_programs(options.export_folder, sequences);
    return 0;
  }
  mpm::register_qp_benchmarks(sequences);
  mpm::register_loop_benchmarks(study);
  mpm::register_study_benchmarks(study, options.experiments);
  mpm::register_size_benchmarks();
  return measure(argv[0], options.rest);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mpmbench_perf: %s\n", error.what());
    return 2;
  }
}
