// usage: interval_coverage ARCHIVE DRAWS [SEED]
//
// How often the intervals of slope, intercept and R^2 hold what they should: DRAWS times as many experiments
// of each kind as a study of 400 has are drawn from ARCHIVE without replacement, and the intervals of this
// study are held against the line through all experiments of the archive. Its first method must estimate
// Ivar_basis, and it must have many times more experiments than 400.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "analysis/findings/kind_findings.hpp"
#include "base/error.hpp"
#include "results/archive/archive.hpp"
#include "scenarios/faults/fault.hpp"
#include "scenarios/random/random_stream.hpp"

namespace {

using namespace mpm;

using OfKind = std::map<ExperimentKind, std::vector<const ExperimentRecord*>>;

/// How often a number of the regression is covered, and on which side it is not.
struct Coverage {
  int inside = 0, below = 0, above = 0;

  void add(const Interval& interval, double value) {
    ++(value < interval.lower ? below : value > interval.upper ? above : inside);
  }

  void print(const char* name, double value) const {
    const double draws = inside + below + above;
    fmt::print("  {:9} {:8.4g}  covered {:5.1f} %, below {:4.1f} %, above {:4.1f} %\n", name, value,
               100.0 * inside / draws, 100.0 * below / draws, 100.0 * above / draws);
  }
};

LinearFitIntervals regression(const Study& study, const AssessmentForm& form, ExperimentKind kind,
                              std::span<const ExperimentRecord* const> records) {
  const auto collector = kind_collector(study, form, 0);
  for (const ExperimentRecord* record : records)
    collector.add(*record);
  const auto kinds = collector.result();
  return std::ranges::find(kinds, kind, &KindFindings::kind)->regression;
}

/// The first `count` records after these have been shuffled.
std::span<const ExperimentRecord* const> draw(std::vector<const ExperimentRecord*>& records,
                                              std::size_t count, RandomStream& stream) {
  for (std::size_t i = 0; i < count; ++i)
    std::swap(records[i], records[i + stream.below(records.size() - i)]);
  return std::span(records).first(count);
}

void print_coverage(Study study, const AssessmentForm& form, ExperimentKind kind,
                    std::vector<const ExperimentRecord*> records, std::size_t count, int draws) {
  const LinearFit all = regression(study, form, kind, records).fit;
  Coverage slope, intercept, r_squared;
  RandomStream stream(study.seed, 0, StreamId::mismatch);
  for (int i = 0; i < draws; ++i) {
    ++study.seed;  // other resamples
    const auto of_draw = regression(study, form, kind, draw(records, count, stream));
    slope.add(of_draw.slope, all.slope);
    intercept.add(of_draw.intercept, all.intercept);
    r_squared.add(of_draw.r_squared, all.r_squared);
  }
  fmt::print("{}: {} times {} of {} experiments\n", to_string(kind), draws, count, records.size());
  slope.print("slope", all.slope);
  intercept.print("intercept", all.intercept);
  r_squared.print("R^2", all.r_squared);
}

int run(const char* archive, int draws, std::uint64_t seed) {
  Campaign campaign = read_archive(archive);
  campaign.study.seed = seed;
  OfKind of_kind;
  for (const ExperimentRecord& record : campaign.records)
    of_kind[record.draw.kind].push_back(&record);
  for (auto& [kind, records] : of_kind)
    print_coverage(campaign.study, *campaign.methods.at(0).form, kind, records,
                   400 * records.size() / campaign.records.size(), draws);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 3 || argc > 4)
      throw InputError("arguments", fmt::format("{}", argc - 1), "ARCHIVE DRAWS [SEED]");
    return run(argv[1], std::atoi(argv[2]), argc == 4 ? std::strtoull(argv[3], nullptr, 10) : 1);
  } catch (const std::exception& error) {
    fmt::print(stderr, "interval_coverage: {}\n", error.what());
    return 2;
  }
}
