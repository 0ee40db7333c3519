#include "analysis/methods/assessment_record.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "analysis/methods/method_table.hpp"
#include "base/non_finite.hpp"
#include "base/row_major.hpp"

namespace mpm {
namespace {

constexpr const char* kMismatchBound = "mismatch_bound";
constexpr const char* kToldSource = "told_source";

/// A number of each method that names mismatches. It is not among implied_numbers(), because archives that
/// are older than this number do not have it.
AssessmentNumberInfo mismatch_bound_info() {
  return {{kMismatchBound, "the size lies at an end of the searched range, so it is only a bound", "1", "",
           numbered({"none", "at_most", "at_least"})},
          NumberScope::channel};
}

/// The bound with this number; SizeBound::none if the answer has no such number.
SizeBound bound_of(double number) {
  for (const SizeBound bound : {SizeBound::at_most, SizeBound::at_least})
    if (number == static_cast<double>(bound))
      return bound;
  return SizeBound::none;
}

std::vector<AssessmentNumberInfo> implied_numbers(const MethodDescription& method) {
  std::vector<AssessmentNumberInfo> numbers;
  const auto worded = [&](const char* name, NumberScope scope, const char* meaning,
                          std::vector<NumberWord> words) {
    numbers.push_back({{name, meaning, "1", "", std::move(words)}, scope});
  };
  if (method.locates_cvs) {
    worded("cv_flagged", NumberScope::cv, "the method flags the CV", no_yes());
    numbers.emplace_back("cv_score", NumberScope::cv,
                         "how far the CV is from being flagged, larger is worse");
  }
  if (method.tells_sources)
    worded("cv_source", NumberScope::cv, "source that the method names for a flagged CV or the worst one",
           enum_words<FaultSource>());
  if (method.names_channels)
    worded("channel_flagged", NumberScope::channel, "the method names this channel of the model", no_yes());
  if (method.names_mismatches) {
    worded("mismatch_parameter", NumberScope::channel,
           "parameter of this channel that the method says is wrong", enum_words<MismatchParameter>());
    numbers.emplace_back("mismatch_size", NumberScope::channel,
                         "size of this mismatch, in the form of `parameter_value` of an experiment");
    numbers.emplace_back("mismatch_lower", NumberScope::channel, "lower end of the interval of the size");
    numbers.emplace_back("mismatch_upper", NumberScope::channel, "upper end of the interval of the size");
  }
  if (method.names_candidates)
    numbers.emplace_back(
        "named_candidate", NumberScope::loop,
        "position of the logged signal that drives the disturbance, according to the method");
  return numbers;
}

}  // namespace

AssessmentForm::AssessmentForm(MethodDescription method, const Study& study) : method_(std::move(method)) {
  for (AssessmentNumberInfo& info : implied_numbers(method_))
    add(std::move(info), study);
  for (const AssessmentNumberInfo& info : method_.numbers)
    add(info, study);
  if (study.monitoring) {
    add({{"window_flagged", "the method flags the loop in this window", "1", "", no_yes()},
         NumberScope::window},
        study);
    add({"window_score", NumberScope::window, "its score in this window, larger is worse"}, study);
  }
}

void AssessmentForm::add(AssessmentNumberInfo info, const Study& study) {
  const bool of_loop = info.scope == NumberScope::loop || info.scope == NumberScope::window;
  const Eigen::Index columns = info.scope == NumberScope::channel  ? study.mv_count()
                               : info.scope == NumberScope::cv_lag ? lag_count(study)
                               : info.scope == NumberScope::window
                                   ? study.monitoring->count(study.simulation.samples)
                                   : 1;
  places_.push_back({std::move(info), size_, of_loop ? 1 : study.cv_count(), columns});
  size_ += places_.back().size();
}

const NumberPlace* AssessmentForm::find(std::string_view name) const {
  const auto place = std::find_if(places_.begin(), places_.end(),
                                  [name](const NumberPlace& each) { return each.info.name == name; });
  return place == places_.end() ? nullptr : &*place;
}

Eigen::Index lag_count(const Study& study) {
  return study.simulation.samples / 4 + 1;
}

AssessmentForms assessment_forms(const Study& study, const std::vector<std::string>& methods) {
  AssessmentForms forms;
  for (const std::string& name : methods) {
    const AssessmentMethodInfo& info = method_table(study.assessment).method(name);
    MethodDescription description = info;
    if (study.names_scenarios() && info.scenario_numbers)
      for (AssessmentNumberInfo& number : info.scenario_numbers())
        description.numbers.push_back(std::move(number));
    if (info.names_mismatches)
      description.numbers.push_back(mismatch_bound_info());
    if (info.tells_sources)
      description.numbers.push_back(told_source_info());
    if (info.states_false_alarms)
      description.stated_false_alarms = info.states_false_alarms(study.assessment);
    forms.push_back(std::make_shared<const AssessmentForm>(std::move(description), study));
  }
  return forms;
}

AssessmentNumberInfo told_source_info() {
  return {{kToldSource, "source of the predicted CV; for another fault, its place", "1", "",
           enum_words<ToldSource>()},
          NumberScope::loop};
}

double AssessmentRecord::number(std::string_view name, Eigen::Index row, Eigen::Index column) const {
  const NumberPlace* const place = form ? form->find(name) : nullptr;
  if (place == nullptr || numbers.size() == 0)
    return kNaN;
  assert(row >= 0 && row < place->rows && column >= 0 && column < place->columns);
  return numbers(place->first + row * place->columns + column);
}

Eigen::MatrixXd AssessmentRecord::values(std::string_view name) const {
  const NumberPlace* const place = form ? form->find(name) : nullptr;
  if (place == nullptr || numbers.size() == 0)
    return {};
  return Eigen::Map<const RowMajorMatrix>(numbers.data() + place->first, place->rows, place->columns);
}

void AssessmentRecord::set_number(std::string_view name, double value, Eigen::Index row,
                                  Eigen::Index column) {
  const NumberPlace* const place = form->find(name);
  assert(place != nullptr && row < place->rows && column < place->columns);
  numbers(place->first + row * place->columns + column) = value;
}

bool AssessmentRecord::flags(Eigen::Index cv) const {
  return number("cv_flagged", cv) == 1.0;
}

ToldSource AssessmentRecord::told() const {
  const double kept = number(kToldSource);
  for (const ToldSource told : enumerators<ToldSource>())
    if (kept == static_cast<double>(told) && source_of(told) == predicted_source)
      return told;
  return told_source(predicted_source);
}

FaultSource AssessmentRecord::source_on(Eigen::Index cv) const {
  const double source = flags(cv) ? number("cv_source", cv) : kNaN;
  return std::isnan(source) ? FaultSource::none : static_cast<FaultSource>(static_cast<int>(source));
}

bool AssessmentRecord::names(const Channel& channel) const {
  return number("channel_flagged", channel.cv, channel.mv) == 1.0;
}

void add_window(AssessmentRecord& record, Eigen::Index window, const Assessment& said) {
  if (said.status != AssessmentStatus::ok)
    return;
  record.set_number("window_flagged", said.flagged ? 1.0 : 0.0, 0, window);
  record.set_number("window_score", said.score, 0, window);
}

std::optional<NamedMismatch> AssessmentRecord::named_mismatch() const {
  const Eigen::MatrixXd parameters = values("mismatch_parameter");
  for (Eigen::Index cv = 0; cv < parameters.rows(); ++cv)
    for (Eigen::Index mv = 0; mv < parameters.cols(); ++mv)
      if (!std::isnan(parameters(cv, mv)))
        return NamedMismatch{{cv, mv},
                             static_cast<MismatchParameter>(parameters(cv, mv)),
                             number("mismatch_size", cv, mv),
                             number("mismatch_lower", cv, mv),
                             number("mismatch_upper", cv, mv),
                             bound_of(number(kMismatchBound, cv, mv))};
  return std::nullopt;
}

std::vector<AssessmentRecord> unassessed(const AssessmentForms& forms) {
  std::vector<AssessmentRecord> records(forms.size());
  for (std::size_t method = 0; method < forms.size(); ++method)
    records[method].form = forms[method];
  return records;
}

AssessmentRecord kept(std::shared_ptr<const AssessmentForm> form, const Assessment& assessment) {
  AssessmentRecord record;
  record.form = std::move(form);
  record.status = assessment.status;
  record.reason = assessment.reason;
  if (assessment.status != AssessmentStatus::ok)
    return record;
  const MethodDescription& method = record.form->method();
  record.flagged = assessment.flagged;
  record.score = assessment.score;
  record.numbers = Eigen::VectorXd::Constant(record.form->size(), kNaN);
  if (const std::optional<Eigen::Index> worst = assessment.worst_cv()) {
    record.predicted_cv = *worst;
    const CvAssessment& of_worst = assessment.cvs[static_cast<std::size_t>(*worst)];
    record.predicted_source = of_worst.source;
    if (record.form->find(kToldSource) != nullptr)
      record.set_number(kToldSource, static_cast<double>(told_source(of_worst.source, of_worst.about)));
  }
  for (std::size_t i = 0; i < assessment.cvs.size() && method.locates_cvs; ++i) {
    const CvAssessment& of_cv = assessment.cvs[i];
    const auto cv = static_cast<Eigen::Index>(i);
    if (of_cv.flagged)
      record.set_number("cv_flagged", *of_cv.flagged ? 1.0 : 0.0, cv);
    record.set_number("cv_score", of_cv.score, cv);
    if (method.tells_sources)
      record.set_number("cv_source", static_cast<double>(of_cv.source), cv);
  }
  if (method.names_channels) {
    const NumberPlace& place = *record.form->find("channel_flagged");
    record.numbers.segment(place.first, place.size()).setZero();
    for (const Channel& channel : assessment.flagged_channels)
      record.set_number("channel_flagged", 1.0, channel.cv, channel.mv);
  }
  if (const auto& named = assessment.named_mismatch; named && method.names_mismatches) {
    const auto [cv, mv] = named->channel;
    record.set_number("mismatch_parameter", static_cast<double>(named->parameter), cv, mv);
    record.set_number("mismatch_size", named->size, cv, mv);
    if (record.form->find(kMismatchBound) != nullptr)
      record.set_number(kMismatchBound, static_cast<double>(named->bound), cv, mv);
    record.set_number("mismatch_lower", named->lower, cv, mv);
    record.set_number("mismatch_upper", named->upper, cv, mv);
  }
  if (assessment.named_candidate && method.names_candidates)
    record.set_number("named_candidate", static_cast<double>(*assessment.named_candidate));
  for (const AssessmentNumber& number : assessment.numbers)
    record.set_number(number.name, number.value, std::max<Eigen::Index>(number.cv, 0),
                      std::max<Eigen::Index>(number.column, 0));
  return record;
}

}  // namespace mpm
