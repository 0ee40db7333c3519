#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/assessment.hpp"
#include "base/enum_words.hpp"
#include "base/number_text.hpp"
#include "scenarios/study/assessment_options.hpp"

// The one interface of all methods that assess a loop, including the chain of the thesis. A method is one
// file, which implements AssessmentMethod and describes it by an AssessmentMethodInfo. The function of this
// file is in the list of analysis/methods/method_table.cpp.

namespace mpm {

/// What a method needs from a loop. If something is missing, the method reports that it does not apply.
struct AssessmentRequirements {
  bool setpoints = false;         ///< some CV has a setpoint
  bool moving_setpoints = false;  ///< some setpoint changes during the record
  bool benchmark = false;         ///< a period in which the controller worked as designed
  bool moving_mvs = false;        ///< some MV moves during the record
  bool nominal_loop = false;      ///< the controller can run on its own model: for S0 or the nominal loop
  bool complete_record = true;    ///< no sample of a CV is missing, in the record and in the benchmark
  /// Where the method, which needs a complete record, sees held analyses: from the sample at which the
  /// controller saw them, instead of the sample at which they were taken. For methods based on T0.
  bool analyses_as_shown = false;
};

/// How a method uses the errors of the model that the benchmark shows (AssessmentContext::correction), if the
/// study learns them. A study can vary this use by itself: with_other_information() gives the same method
/// with or without these errors.
enum class ModelInformation : std::int8_t {
  unused,   ///< the method does not look at y_sim, or uses model errors of its own
  nominal,  ///< it does not use them: y_sim is that of the nominal model
  shown,    ///< y_sim of loop and benchmark contains them: the method sees the changes since the benchmark
  learnt,   ///< the method asks for them itself
  denied,   ///< the method asks for them and receives none
};

template <>
inline constexpr auto kWords<ModelInformation> = word_list("not used", "nominal",
                                                           "corrected by the benchmark",
                                                           "learnt from the benchmark",
                                                           "nominal, nothing learnt");

/// The scope of a number: the whole loop, each CV, each channel, each CV at each lag, or each window of a
/// study with monitoring.
enum class NumberScope { loop, cv, channel, cv_lag, window };

/// How the findings of a study summarise a number.
enum class NumberFinding {
  none,
  summary,  ///< least, mean and largest value over the experiments of each kind; for numbers of the loop only
  regression  ///< for an estimate of the loss of variance of each CV: regression of Ivar_basis (6.22) on it
};

/// A number that a method gives besides its verdicts, as archive, findings, report and gates use it. In table
/// files its full name is METHOD.NAME. Its words, if any, are those for the values 0, 1, 2, ...
struct AssessmentNumberInfo : NumberText {
  AssessmentNumberInfo(NumberText text, NumberScope of, NumberFinding becomes = NumberFinding::none)
      : NumberText(std::move(text)), scope(of), finding(becomes) {}
  AssessmentNumberInfo(std::string called, NumberScope of, std::string means, std::string in = "1",
                       NumberFinding becomes = NumberFinding::none)
      : AssessmentNumberInfo({std::move(called), std::move(means), std::move(in)}, of, becomes) {}

  NumberScope scope;
  NumberFinding finding;
};

/// A method that has learnt its context and assesses one loop after another. It keeps workspaces between
/// them, so each thread needs its own. An answer depends on its loop only, not on earlier ones.
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

/// All that other code needs to know about a method. An archive holds it too, for readers that do not have
/// the method.
struct MethodDescription {
  std::string name;     ///< on the command line and in table files: "sun"
  std::string title;    ///< "Sun et al. (2013)"
  std::string verdict;  ///< meaning of a flagged loop, in one line
  AssessmentRequirements requirements;
  bool locates_cvs = false;       ///< Assessment::cvs holds verdicts
  bool names_channels = false;    ///< Assessment::flagged_channels
  bool tells_sources = false;     ///< CvAssessment::source
  bool names_mismatches = false;  ///< Assessment::named_mismatch
  bool names_candidates = false;  ///< Assessment::named_candidate
  ModelInformation information = ModelInformation::nominal;
  /// The share of healthy loops that the method states it flags; none if it states no share.
  std::optional<double> stated_false_alarms = {};
  std::vector<AssessmentNumberInfo> numbers;
  /// Where the answers come from if the method is not part of this program; empty otherwise.
  std::string origin = {};
  /// What determines the answers of an outside method besides its name: its command with the content of its
  /// files, and its options. Empty for methods of this program.
  std::string fingerprint = {};
  /// The options in the fingerprint, as JSON; empty for methods of this program.
  std::string given_options = {};
};

/// The options of a method. `keys` ties their keys to a value of type Options; `meaning` is for the manual.
template <class Options>
MethodOptionTable option_table(std::vector<OptionKey> (*keys)(Options&), std::string meaning) {
  return {std::move(meaning), [keys](MethodOptions& options) { return keys(options.of<Options>()); }};
}

/// A method of this program.
struct AssessmentMethodInfo : MethodDescription {
  using Make = std::function<std::unique_ptr<AssessmentMethod>(const AssessmentContext& context)>;
  /// A variant of the method, NAME:END: it lacks one of its parts, or has a flaw repaired.
  struct Reduced {
    std::string end, title;
    Make make;
  };

  /// Additional numbers on the loops of a study of named scenarios, in which every CV is examined; may be
  /// empty.
  std::function<std::vector<AssessmentNumberInfo>()> scenario_numbers;
  /// `context` must outlive the method. Throws InputError for options that do not fit the study.
  Make make;
  /// Its options, by option_table(); may be empty.
  std::optional<MethodOptionTable> options = {};
  /// MethodDescription::stated_false_alarms with these options; may be empty.
  std::function<std::optional<double>(const MethodOptions& options)> states_false_alarms = {};
  std::vector<Reduced> reduced = {};
};

/// Endings of the names that with_other_information() gives.
inline constexpr std::string_view kCorrected = ":corrected", kUncorrected = ":uncorrected";

/// The method with the correction that it lacks, NAME:corrected, or without the correction that it has,
/// NAME:uncorrected; none for a method that does not look at y_sim. The variant has the options of the
/// method.
std::optional<AssessmentMethodInfo> with_other_information(const AssessmentMethodInfo& method);

/// The variants of AssessmentMethodInfo::reduced as methods, with the options of the method.
std::vector<AssessmentMethodInfo> reduced_methods(const AssessmentMethodInfo& method);

/// The first requirement that the loop or its context does not meet, in one sentence; none if all are met.
std::optional<std::string> unmet_requirement(const AssessmentRequirements& requirements,
                                             const AssessmentContext& context, const AssessedLoop& loop);

/// A method with its context. It checks first whether the method applies. The answer is a value derived from
/// the loop: while the loop keeps derived values, the method runs once for all callers.
class Assessor {
 public:
  /// `context` must outlive the assessor.
  Assessor(const AssessmentMethodInfo& info, const AssessmentContext& context);

  /// The verdict on a loop of the context's study. It is `failed`, with the reason, if a value of the loop or
  /// of the benchmark is out_of_proportion(), if the method refuses the records of either, if the score of
  /// the loop or of a CV that it judges is not a number, or if a method that locates CVs flags the loop
  /// without the score of any CV. So one odd loop does not cost the verdicts on the others.
  Assessment assess(const AssessedLoop& loop);

 private:
  Assessment asked(const AssessedLoop& loop);
  Assessment asked_of_seen(const AssessedLoop& loop);
  void learn();
  std::shared_ptr<const AssessedLoop> with_held(const AssessedLoop& loop) const;
  Assessment answer_of_method(const AssessedLoop& loop);
  const AssessmentContext& seen() const { return seen_ ? *seen_ : context_; }

  std::string name_;
  AssessmentRequirements requirements_;
  bool locates_cvs_;
  ModelInformation information_;  ///< shown or denied only if there is a correction
  const AssessmentContext& context_;
  AssessmentMethodInfo::Make make_;
  std::optional<std::string> unusable_;  ///< why nothing can be learnt from the benchmark
  bool holds_analyses_;
  std::unique_ptr<AssessmentContext> seen_;  ///< `context_` with other signals or information; may be null
  /// The whole record of the benchmark of `seen_`, if that benchmark is a window.
  std::shared_ptr<const AssessedLoop> of_benchmark_;
  std::unique_ptr<AssessmentMethod> method_;  ///< made for the first loop to which it applies
};

/// The assessor of this method under the context, shared by all callers: the panel, and methods that use
/// another method. Each caller gets its own if the context keeps no derived values.
std::shared_ptr<Assessor> shared_assessor(const AssessmentMethodInfo& info, const AssessmentContext& context);

}  // namespace mpm
