#include "bench/cache/loop_memory.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <exception>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "analysis/methods/broken_promise.hpp"
#include "analysis/methods/method_table.hpp"
#include "analysis/methods/threshold_rule.hpp"
#include "base/non_finite.hpp"
#include "base/sha256.hpp"
#include "base/system/loaded_code.hpp"
#include "base/system/surroundings.hpp"
#include "bench/execution/loop_keys.hpp"
#include "bench/shards/shard_identity.hpp"
#include "results/files/byte_stream.hpp"
#include "results/files/deflated.hpp"

namespace mpm {
namespace {

/// A campaign keeps no loops beyond this number of bytes, because it holds all kept loops in memory.
constexpr std::size_t kMostHeld = std::size_t{256} << 20;

/// A digest of what decides the last bits of a result besides the program: libraries, processor, and their
/// settings.
std::string this_machine() {
  std::string text = loaded_code();
  for (const char* const name :
       std::array{"MPMBENCH_KERNELS", "OPENBLAS_CORETYPE", "OPENBLAS_NUM_THREADS", "GLIBC_TUNABLES"})
    if (const char* const value = std::getenv(name))
      text += fmt::format("{}={}\n", name, value);
  return digest_of(text);
}

ShardIdentity memory_identity(const Study& study, const RunOptions& options, const char* content) {
  static const std::string of_machine = this_machine();
  return {{"content", content},
          {"program", program_identity()},
          {"machine", of_machine},
          {"study", sha256(std::as_bytes(std::span(study.source)))},
          {"seed", fmt::format("{}", study.seed)},
          {"solver", options.solver},
          {"workers", runs_in_threads(study, options) ? "threads" : "processes"}};
}

template <class Stream, class Answer>
void transfer_answer(Stream& stream, Answer& answer) {
  auto& [form, status, reason, flagged, score, cv, source, numbers, milliseconds] = answer;
  transfer_all(stream, status, reason, flagged, score, cv, source, numbers, milliseconds);
}

template <class Stream, class Answers>
void transfer_answers(Stream& stream, Answers& answers) {
  transfer_list(stream, answers, [&](auto& answer) { transfer_all(stream, answer.first, answer.second); });
}

std::string bytes_to_keep(const std::string& loop,
                          const std::vector<std::pair<std::string, std::string>>& answers) {
  if (loop.empty() && answers.empty())
    return "";
  ByteWriter writer;
  transfer(writer, loop);
  transfer_answers(writer, answers);
  return writer.take();
}

/// Whether two answers agree in everything but the time that they took.
bool is_same_answer(const AssessmentRecord& one, const AssessmentRecord& other) {
  const auto bytes_of = [](AssessmentRecord answer) {
    answer.milliseconds = kNaN;
    ByteWriter writer;
    transfer_answer(writer, std::as_const(answer));
    return writer.take();
  };
  return bytes_of(one) == bytes_of(other);
}

/// Whether each audited step has the same status as with Ipopt. A different one may be a matter of Ipopt's
/// time limit.
bool all_of_audit_agree(const std::vector<AuditedStep>& audited) {
  return std::all_of(audited.begin(), audited.end(), [](const AuditedStep& step) {
    return step.targets.same_status && step.moves.same_status;
  });
}

/// The record without answers. It keeps its loop only if its status is ok, so that methods can assess it
/// again; y_sim, which follows from the loop, is set to zero.
ExperimentRecord unanswered(ExperimentRecord record) {
  record.assessments.clear();
  if (record.status != ExperimentStatus::ok)
    record.loop.reset();
  if (record.loop)
    record.loop->y_sim =
        Eigen::MatrixXd::Zero(record.loop->trajectory.y.rows(), record.loop->trajectory.y.cols());
  return record;
}

}  // namespace

void KnownLoop::require_expected() const {
  for (const AssessmentRecord& before : expected) {
    const std::string& method = before.form->method().name;
    for (const AssessmentRecord& now : record.assessments)
      if (now.form->method().name == method && now.status != AssessmentStatus::failed &&
          !is_same_answer(before, now))
        throw BrokenPromise(
            fmt::format("method '{}': threshold_option", method),
            fmt::format("an answer on loop {} that differs from the one with the previous threshold",
                        record.draw.index),
            "answers that depend on the loop, the command with the content of its files and the "
            "other options, and by their flags alone on this one; --fresh asks about all loops "
            "again");
  }
}

bool LoopMemory::may_keep(const Study& study, const RunOptions& options) {
  return !has_foreign_part(study) && !options.assessor && options.store == StorePolicy::none;
}

LoopMemory::LoopMemory(const Study& study, const Study* calibration, const RunOptions& options)
    : folder_(options.cache),
      loop_identity_(memory_identity(study, options, "loops")),
      answer_identity_(memory_identity(study, options, "answers")),
      forms_(assessment_forms(study, study_methods(study))),
      bytes_(study, AssessmentForms{}),
      audit_share_(audited_share(study, options)) {
  if (calibration != nullptr)
    calibration_bytes_.emplace(*calibration, AssessmentForms{});
  for (const auto& form : forms_)
    kept_[form->method().name] = kept_as(form->method(), options);
  if (!options.fresh)
    read();
}

void LoopMemory::read() {
  const std::optional<ShardContent> loops = folder_->read(loop_identity_);
  const std::optional<ShardContent> answers = loops ? folder_->read(answer_identity_) : std::nullopt;
  if (!loops)
    return;
  for (const ShardPlace& place : loops->places)
    held_ += loops_.insert_or_assign(place.key, loops->bytes(place)).first->second.size();
  if (!answers)
    return;
  for (const ShardPlace& place : answers->places) {
    NamedAnswers named;
    ByteReader reader(answers->bytes(place));
    try {
      transfer_answers(reader, named);
    } catch (const std::runtime_error&) {  // bytes that this program does not write
      continue;
    }
    answers_[place.key] = Answers(named.begin(), named.end());
  }
}

LoopMemory::Kept LoopMemory::kept_as(const MethodDescription& method, const RunOptions& options) {
  if (method.origin.empty())
    return {.name = method.name};
  // Variants, NAME:END, have the options of the method.
  const auto option = options.threshold_options.find(method.name.substr(0, method.name.find(':')));
  if (option == options.threshold_options.end())
    return {};
  return {.name = fmt::format("{}: {}", method.name, fingerprint_without(option->second, method)),
          .threshold = threshold_in(method.given_options, option->second)};
}

const OutcomeBytes& LoopMemory::bytes_of(std::int64_t key) const {
  return key < kCalibrationKeys || !calibration_bytes_ ? bytes_ : *calibration_bytes_;
}

double LoopMemory::audit_share_of(std::int64_t key) const {
  return key < kCalibrationKeys ? audit_share_ : 0.0;
}

std::optional<KnownLoop> LoopMemory::find(std::int64_t key) const {
  std::optional<KnownLoop> known = kept_loop(key);
  const double share = audit_share_of(key);
  if (!known || !known->has_truth || (share > 0.0 && known->audit_share != share))
    return std::nullopt;
  if (share == 0.0)
    known->audited.clear();
  return known;
}

std::optional<KnownLoop> LoopMemory::find_same(std::int64_t key, const ExperimentRecord& record) const {
  std::optional<KnownLoop> known = kept_loop(key);
  if (!known || known->record.status != ExperimentStatus::ok)
    return std::nullopt;
  const std::optional<LoopRecord> loop = std::exchange(known->record.loop, std::nullopt);
  ExperimentRecord without = record;
  without.loop.reset();
  without.truth.reset();
  if (!bytes_of(key).differences({.record = without}, {.record = known->record}).empty())
    return std::nullopt;
  known->record.loop = loop;
  return known;
}

std::optional<KnownLoop> LoopMemory::kept_loop(std::int64_t key) const {
  const auto loop = loops_.find(key);
  if (loop == loops_.end())
    return std::nullopt;
  try {
    return known_loop(key, loop->second);
  } catch (const std::exception& error) {  // bytes that this program does not write
    if (is_of_surroundings(error))
      throw;
    return std::nullopt;
  }
}

KnownLoop LoopMemory::known_loop(std::int64_t key, const std::string& loop) const {
  KnownLoop known;
  const std::string bytes = inflated(loop);
  ByteReader reader(bytes);
  transfer_all(reader, known.has_truth, known.by_process, known.audit_share);
  ExperimentOutcome outcome =
      bytes_of(key).from_bytes(std::string_view(bytes).substr(bytes.size() - reader.left()));
  known.record = std::move(outcome.record);
  known.audited = std::move(outcome.audited);
  if (known.record.draw.index != key % kCalibrationKeys)
    throw std::runtime_error(fmt::format("loop {}", known.record.draw.index));
  known.record.assessments = unassessed(forms_);
  if (known.record.status != ExperimentStatus::ok)
    return known;
  const auto answers = answers_.find(key);
  for (AssessmentRecord& said : known.record.assessments) {
    const std::string& method = said.form->method().name;
    const Kept& kept = kept_.find(method)->second;
    if (answers == answers_.end() || kept.name.empty() || answers->second.count(kept.name) == 0) {
      known.unheard.push_back(method);
      continue;
    }
    ByteReader answer(answers->second.find(kept.name)->second);
    transfer_answer(answer, said);
    answer.require_end();
    if (!kept.threshold)
      continue;
    flag_anew(said, *kept.threshold);
    if (key % kCheckedLoops == 0) {
      known.unheard.push_back(method);
      known.expected.push_back(said);
    }
  }
  return known;
}

/// The answers of the methods `asked` that may be kept.
LoopMemory::NamedAnswers LoopMemory::answers_to_keep(const ExperimentRecord& record,
                                                     const std::vector<std::string>& asked,
                                                     bool by_process) const {
  NamedAnswers answers;
  for (const AssessmentRecord& said : record.assessments) {
    const MethodDescription& method = said.form->method();
    const std::string& name = kept_.find(method.name)->second.name;
    // A failure may be a matter of time: Ipopt, which runs in processes only, has a time limit, and so has a
    // program.
    const bool is_kept = said.status == AssessmentStatus::failed ? !by_process && method.origin.empty()
                                                                 : record.status == ExperimentStatus::ok;
    if (name.empty() || !is_kept || std::find(asked.begin(), asked.end(), method.name) == asked.end())
      continue;
    ByteWriter writer;
    transfer_answer(writer, said);
    answers.emplace_back(name, writer.take());
  }
  return answers;
}

std::string LoopMemory::to_keep(std::int64_t key, const KnownLoop& loop) const {
  if (loop.record.status == ExperimentStatus::failed || !all_of_audit_agree(loop.audited))
    return "";
  ByteWriter writer;
  transfer_all(writer, loop.has_truth, loop.by_process, loop.audit_share);
  const std::string content =
      writer.take() +
      bytes_of(key).to_bytes({.record = unanswered(loop.record), .samples = {}, .audited = loop.audited});
  std::vector<std::string> all;
  for (const auto& form : forms_)
    all.push_back(form->method().name);
  return bytes_to_keep(deflated(content), answers_to_keep(loop.record, all, loop.by_process));
}

std::string LoopMemory::to_keep(const KnownLoop& known) const {
  return bytes_to_keep("", answers_to_keep(known.record, known.unheard, known.by_process));
}

void LoopMemory::take(std::int64_t key, std::string bytes) {
  if (held_ + bytes.size() > kMostHeld)
    return;
  held_ += bytes.size();
  taken_.emplace_back(key, std::move(bytes));
}

void LoopMemory::merge(std::int64_t key, const std::string& bytes) {
  ByteReader reader(bytes);
  std::string loop;
  NamedAnswers answers;
  transfer(reader, loop);
  transfer_answers(reader, answers);
  if (!loop.empty()) {
    loops_.insert_or_assign(key, std::move(loop));
    new_loops_ = true;
  }
  if (answers.empty() || loops_.count(key) == 0)
    return;
  for (auto& [method, answer] : answers)
    answers_[key].insert_or_assign(method, std::move(answer));
  new_answers_ = true;
}

std::optional<std::string> LoopMemory::write() {
  for (const auto& [key, bytes] : std::exchange(taken_, {}))
    merge(key, bytes);
  std::optional<std::string> trouble;
  if (std::exchange(new_loops_, false)) {
    ShardBytes content;
    for (const auto& [key, loop] : loops_)
      content.add(key, loop);
    trouble = folder_->write(content, loop_identity_);
  }
  if (std::exchange(new_answers_, false)) {
    ShardBytes content;
    for (const auto& [key, of_loop] : answers_) {
      const NamedAnswers named(of_loop.begin(), of_loop.end());
      ByteWriter writer;
      transfer_answers(writer, named);
      content.add(key, writer.take());
    }
    const std::optional<std::string> second = folder_->write(content, answer_identity_);
    trouble = trouble ? trouble : second;
  }
  return trouble;
}

KeepAtEnd::~KeepAtEnd() {
  try {
    const std::optional<std::string> trouble = memory_ == nullptr ? std::nullopt : memory_->write();
    if (trouble && warn_)
      warn_(fmt::format("loops are not kept for the next run: {}", *trouble));
  } catch (const std::exception&) {  // no memory is left: then nothing is kept
  }
}

}  // namespace mpm
