#include "bench/outcome/outcome_bytes.hpp"

#include "analysis/methods/method_table.hpp"
#include "results/files/byte_stream.hpp"

namespace mpm {
namespace {

template <class Stream, class Outcome>
void transfer_audit(Stream& stream, Outcome& outcome) {
  const auto all = [&stream](auto&... values) { transfer_all(stream, values...); };
  const auto problem = [&](auto& p) {
    all(p.data.gradient, p.data.lower, p.data.upper, p.data.hard_lower, p.data.hard_upper, p.data.soft_lower,
        p.data.soft_upper, p.status, p.x, p.objective);
  };
  transfer_list(stream, outcome.samples, [&](auto& sample) {
    all(sample.experiment, sample.step);
    problem(sample.targets);
    problem(sample.moves);
  });
  const auto difference = [&](auto& d) { all(d.same_status, d.x, d.objective); };
  transfer_list(stream, outcome.audited, [&](auto& step) {
    all(step.experiment, step.step, step.ipopt_kkt_residual);
    difference(step.targets);
    difference(step.moves);
  });
  all(outcome.audit_seconds);
}

}  // namespace

OutcomeBytes::OutcomeBytes(const Study& study)
    : OutcomeBytes(study, assessment_forms(study, study_methods(study))) {}

OutcomeBytes::OutcomeBytes(const Study& study, const AssessmentForms& forms) : records_(study, forms) {}

std::string OutcomeBytes::to_bytes(const ExperimentOutcome& outcome) const {
  ByteWriter writer;
  const std::string record = records_.to_bytes(outcome.record);
  transfer(writer, record);
  transfer_audit(writer, outcome);
  return writer.take();
}

ExperimentOutcome OutcomeBytes::from_bytes(std::string_view bytes) const {
  ByteReader reader(bytes);
  ExperimentOutcome outcome;
  std::string record;
  transfer(reader, record);
  outcome.record = records_.from_bytes(record);
  transfer_audit(reader, outcome);
  reader.require_end();
  return outcome;
}

}  // namespace mpm
