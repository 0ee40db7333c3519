#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/assessment.hpp"
#include "analysis/methods/assessment_method.hpp"
#include "base/enum_words.hpp"

// The messages to a method from outside and its answers, as JSON (docs/bring_your_own.md). A number that is
// missing or not finite is null.

namespace mpm {

/// Limits for an outside method: how many numbers of its own, and how many bytes of text about it.
inline constexpr std::size_t kMostMethodNumbers = 1000;
inline constexpr std::size_t kLongestMethodText = 1000;

/// One signal of a loop as methods see it: its name in messages and files, the dimension of its rows.
struct LoopSignal {
  const char* name;
  const char* rows;  ///< "cv", "mv", "md", "candidate"
  const char* meaning;
  Eigen::MatrixXd AssessedLoop::*member;
};

/// y, u, u_target, d, y_sim, y_set, candidates.
const std::vector<LoopSignal>& loop_signals();

/// The form of the signals of a loop in a message: a list for each row, or {"rows": count, "base64": text}
/// with the numbers row by row, 8 bytes each (IEEE 754, little-endian). In a list NaN is null.
enum class SignalForm : std::int8_t { lists, base64 };

template <>
inline constexpr auto kWords<SignalForm> = word_list("lists", "base64");

/// {"y": [[...], ...], ...}: the signals of a loop. A window has "whole" and "first" as well.
nlohmann::ordered_json loop_json(const AssessedLoop& loop, SignalForm form = SignalForm::lists);

/// Puts "y_sim_corrected" beside "y_sim" in the loop_json() of a loop: y_sim of ModelCorrection::corrected(),
/// or y_sim itself if nothing is learnt.
void add_corrected(nlohmann::ordered_json& json, const AssessedLoop& loop, const ModelCorrection* correction,
                   SignalForm form = SignalForm::lists);

/// The plant's variables, sample time, nominal model (transfer functions and step responses), controller,
/// operating point and benchmark (loop_json): all that a method may know besides the loop. No draw, no seed.
nlohmann::ordered_json context_json(const AssessmentContext& context, SignalForm form = SignalForm::lists);

/// The answer of a method of this program on a loop, in the form of a message (see assessment_of()):
/// `cv_flagged`, `cv_score` and `cv_source` of all CVs if the method locates CVs, and its numbers of the
/// loop, of CVs and of channels; `not_applicable` or `error` if there is no verdict.
nlohmann::ordered_json answer_json(const Assessment& assessment, const PlantModel& plant,
                                   const MethodDescription& method);

/// The verdict of an answer:
///
/// | key            | value                                                                            |
/// |----------------|----------------------------------------------------------------------------------|
/// | flagged        | true, false; the only key that must be present                                   |
/// | score          | number, larger is worse; without it 1 or 0 by `flagged`                          |
/// | cv, source     | the worst CV, by name; its source: "none", "mpm", "ud", "mpm_ud", "other"        |
/// | cv_flagged, cv_score, cv_source | lists of ny instead of these two; null: no verdict on the CV  |
/// | channels       | [["y1", "u2"], ...]: the named channels of the model                             |
/// | mismatch       | {"channel", "parameter", "size", "lower", "upper"}; the last three may be absent |
/// | probabilities  | {"none", "mpm", "ud", "mpm_ud", "other"}: numbers from 0 to 1 that add up to 1   |
/// | candidate      | number of the logged signal that drives the disturbance, from 1                  |
/// | numbers        | {"name": value}: numbers of the description; lists by CV, lists of lists by channel |
/// | error, not_applicable | instead of all other keys: why there is no verdict                      |
///
/// Refuses a key that the description of the method does not announce (channels of a method that names none)
/// and an unknown key: InputError, whose text begins with `place`.
Assessment assessment_of(const nlohmann::ordered_json& answer, const PlantModel& plant,
                         const MethodDescription& method, const std::string& place);

}  // namespace mpm
