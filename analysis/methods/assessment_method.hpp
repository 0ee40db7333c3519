#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/assessment.hpp"

// The one interface of all methods that assess a loop, the chain of the thesis among them. A method is one
// file that implements AssessmentMethod and describes it by an AssessmentMethodInfo, and its function in the
// list of analysis/methods/method_table.cpp.

namespace mpm {

/// What a method needs of a loop. Where something is missing it does not apply, and says so.
struct AssessmentRequirements {
  bool setpoints = false;         ///< some CV has a setpoint
  bool moving_setpoints = false;  ///< some setpoint changes during the record
  bool benchmark = false;         ///< a period in which the controller did what it was designed for
  bool moving_mvs = false;        ///< some MV moves during the record
  bool nominal_loop = false;      ///< the controller runs on its own model: S0, or the nominal loop
  bool complete_record = true;    ///< no sample of a CV is missing, in the record and in the benchmark
};

/// What a method gives a number for: the whole loop, each CV, each channel, each CV at each lag, or each
/// window of a study that monitors.
enum class NumberScope { loop, cv, channel, cv_lag, window };

/// A number that a method gives besides its verdicts. Archive, findings, report and gates take it from here.
struct AssessmentNumberInfo {
  std::string
      name;  ///< in the form of a variable name; in table files after the name of the method and a dot
  NumberScope scope = NumberScope::cv;
  std::string meaning;  ///< one line, with its equation
  std::string unit = "1";
  /// What the numbers 0, 1, 2, ... stand for; none for a quantity.
  std::vector<std::string> words = {};
  /// Least, mean and largest value over the experiments of each kind are findings of a study. Of the whole
  /// loop only.
  bool summarised = false;
  std::string label = {};  ///< for tables, of a number that is summarised: "I_{MPM}"
  /// An estimate of the loss of variance of each CV: the regression of Ivar_basis (6.22) on it is a finding.
  bool estimates_ivar_basis = false;
};

/// A method that has learnt what it may know and now assesses loops, one after the other. Keeps workspaces
/// between them: each thread needs its own. An answer depends on the loop alone, not on those before.
class AssessmentMethod {
 public:
  AssessmentMethod() = default;
  AssessmentMethod(const AssessmentMethod&) = delete;
  AssessmentMethod& operator=(const AssessmentMethod&) = delete;
  virtual ~AssessmentMethod() = default;

  /// The verdict on a loop that meets the requirements of the method. Throws InputError for records that it
  /// cannot compute with.
  virtual Assessment assess(const AssessedLoop& loop) = 0;
};

/// All that others need to know of a method without knowing it: an archive describes by it methods that the
/// reader does not have.
struct MethodDescription {
  std::string name;     ///< on the command line and in table files: "sun"
  std::string title;    ///< "Sun et al. (2013)"
  std::string verdict;  ///< what a flagged loop is, in one line
  AssessmentRequirements requirements;
  bool locates_cvs = false;       ///< Assessment::cvs has verdicts
  bool names_channels = false;    ///< Assessment::flagged_channels
  bool tells_sources = false;     ///< CvAssessment::source
  bool names_mismatches = false;  ///< Assessment::named_mismatch
  bool names_candidates = false;  ///< Assessment::named_candidate
  /// The share of loops without a fault that the method says it flags; none: it says nothing of it.
  std::optional<double> stated_false_alarms = {};
  std::vector<AssessmentNumberInfo> numbers;
  /// Where the answers come from when it is no method of this program, in a few words; empty otherwise.
  std::string origin = {};
  /// What decides on the answers of a method from outside besides its name: its command with the content of
  /// its files, and its options. Whoever has it knows it; empty for others.
  std::string fingerprint = {};
};

/// A method that this program has.
struct AssessmentMethodInfo : MethodDescription {
  /// Further numbers on the loops of a study of named scenarios, in which every CV is looked at; may be
  /// empty.
  std::function<std::vector<AssessmentNumberInfo>()> scenario_numbers;
  /// `context` must outlive the method. Throws InputError for options that do not fit the study.
  std::function<std::unique_ptr<AssessmentMethod>(const AssessmentContext& context)> make;
  /// MethodDescription::stated_false_alarms with these options; may be empty.
  std::function<std::optional<double>(const AssessmentOptions& options)> states_false_alarms = {};
};

/// Which requirement the loop or what is known of it does not meet, in one sentence; none: all are met.
std::optional<std::string> unmet_requirement(const AssessmentRequirements& requirements,
                                             const AssessmentContext& context, const AssessedLoop& loop);

/// A method with its context: asks first whether it applies.
class Assessor {
 public:
  /// `context` must outlive the assessor.
  Assessor(const AssessmentMethodInfo& info, const AssessmentContext& context);

  /// The verdict on a loop of the study of the context: `failed` with what the method refuses of this loop,
  /// so that one odd loop does not cost the verdicts on the others, and where a method that locates CVs flags
  /// the loop and has a score of none. Throws InputError as
  /// AssessmentMethodInfo::make.
  Assessment assess(const AssessedLoop& loop);

 private:
  AssessmentRequirements requirements_;
  bool locates_cvs_;
  const AssessmentContext& context_;
  std::function<std::unique_ptr<AssessmentMethod>(const AssessmentContext&)> make_;
  std::unique_ptr<AssessmentMethod> method_;  ///< made for the first loop to which it applies
};

}  // namespace mpm
