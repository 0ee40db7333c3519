#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "results/archive/campaign.hpp"

namespace mpm::testing {

/// A campaign of the small study of tests/scenarios without a simulation: every number is another one, drawn
/// from a written seed, among them NaN with a payload, infinities, -0 and denormals. It has a record of each
/// kind and status, kept loops of complete and broken experiments, texts that are empty or not ASCII, and
/// every method of assessment: where a loop ran to its end the chain has an answer and each of the others one
/// with any status.
Campaign made_up_campaign();

/// The same campaign as one whose records are streamed: from `campaign`, which must outlive it.
Campaign streamed_from(const Campaign& campaign);

/// The same with the faults that the study draws in place of made-up ones: bytes of a record do not hold
/// them.
Campaign drawn_campaign();

/// One whose faults reach further, begin later and are scaled to an effect, so that an archive has the study
/// say what they are.
Campaign rich_campaign();

/// The same without experiments, kept loops, active limits and measured disturbances: every dimension that
/// can be empty is.
Campaign empty_campaign();

/// The same as the first one of a study that has healthy experiments and bad tunings of every parameter, too.
Campaign faultless_campaign();

/// The same as the first one of a study of five named scenarios: healthy, mismatches of an MV and an MD,
/// whole channels, every signal, infeasible, failed; with numbers for every CV.
Campaign scenario_campaign();

/// Every method that this program has, on the loops of a study.
std::vector<CampaignMethod> made_up_methods(const Study& study);

/// A method that was not asked.
AssessmentRecord unasked(std::shared_ptr<const AssessmentForm> form);

/// The verdict on a loop, and nothing else but for the first CV where it must name one.
AssessmentRecord plain_verdict(std::shared_ptr<const AssessmentForm> form, bool flagged, double score);

/// An answer of this form: any status, score and numbers, among them awkward ones. Another one for each
/// `which`.
AssessmentRecord made_up_answer(const Study& study, std::shared_ptr<const AssessmentForm> form,
                                std::uint64_t which);

/// Lets the chain of the thesis, which must be a method of the record, say this.
void set_chain(const Study& study, ExperimentRecord& record, const Diagnosis& diagnosis);

/// Takes the methods with these names out of the campaign, and what they said.
void remove_methods(Campaign& campaign, const std::function<bool(const std::string& name)>& unwanted);

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
