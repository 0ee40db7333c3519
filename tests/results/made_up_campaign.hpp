#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "results/archive/campaign.hpp"

namespace mpm::testing {

/// A campaign of the small study of tests/scenarios without a simulation: every number is another one, drawn
/// from a written seed, among them NaN with a payload, infinities, -0 and denormals. It has a record of each
/// kind and status, kept loops of complete and broken experiments, texts that are empty or not ASCII, and a
/// comparison of methods.
Campaign made_up_campaign();

/// The same without experiments, kept loops, active limits and measured disturbances: every dimension that
/// can be empty is.
Campaign empty_campaign();

/// The same as the first one of a study that has healthy experiments and bad tunings of every parameter, too.
Campaign faultless_campaign();

/// The same as the first one of a study of five named scenarios: healthy, mismatches of an MV and an MD,
/// whole channels, every signal, infeasible, failed; with numbers for every CV.
Campaign scenario_campaign();

/// Verdicts of every method on the experiments of `records` that ran to their end: any status, score and
/// time, among them awkward ones, and channels. The first method always has a verdict and a finite score.
Comparison made_up_comparison(const Study& study, const std::vector<ExperimentRecord>& records);

/// An empty folder that goes away with the test.
class TemporaryFolder {
 public:
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The bytes of a file, and the reverse.
std::string file_content(const std::filesystem::path& path);
void make_file(const std::filesystem::path& path, const std::string& content);

}  // namespace mpm::testing
