#include "bench/record_bytes.hpp"

#include <optional>
#include <type_traits>

#include "bench/byte_stream.hpp"

namespace mpm {
namespace {

template <class Stream, class Fault>
void transfer_optional(Stream& stream, Fault& fault, const auto& members) {
  bool present = fault.has_value();
  transfer(stream, present);
  if constexpr (!std::is_const_v<Fault>)
    if (present)
      fault.emplace();
  if (present)
    members(*fault);
}

template <class Stream, class Record>
void transfer_record(Stream& stream, Record& record) {
  const auto all = [&stream](auto&... values) { transfer_all(stream, values...); };
  all(record.draw.index, record.draw.kind, record.status, record.message);
  transfer_optional(stream, record.draw.mismatch, [&](auto& m) { all(m.cv, m.mv, m.parameter, m.value); });
  transfer_optional(stream, record.draw.disturbance, [&](auto& d) { all(d.cv, d.gain, d.time_constant); });
  auto& diagnosis = record.diagnosis;
  all(diagnosis.ivar, diagnosis.ivar_diag, diagnosis.ivar_basis, diagnosis.impactful, diagnosis.predicted_cv,
      diagnosis.predicted_source);
  auto& indicator = diagnosis.indicator;
  all(indicator.co_dkts, indicator.co_dskn, indicator.i_mpm, indicator.co_kts, indicator.co_skn,
      indicator.scanned, indicator.used);
  all(record.ivar_diag_mpm_alone, record.ivar_diag_ud_alone, record.dominance_mpm);
  all(record.perturbed.time_constant, record.perturbed.damping);
  const auto statistics = [&](auto& s) { all(s.steps, s.iterations, s.fallbacks, s.largest_kkt_residual); };
  statistics(record.solver);
  transfer_optional(stream, record.loop, [&](auto& loop) {
    all(loop.trajectory.status, loop.trajectory.samples_done, loop.trajectory.y, loop.trajectory.u,
        loop.trajectory.u_target, loop.trajectory.d, loop.trajectory.y_set, loop.y_sim);
    statistics(loop.trajectory.solver);
  });
}

}  // namespace

std::string to_bytes(const ExperimentRecord& record) {
  ByteWriter writer;
  transfer_record(writer, record);
  return writer.take();
}

ExperimentRecord record_from_bytes(std::string_view bytes) {
  ByteReader reader(bytes);
  ExperimentRecord record;
  transfer_record(reader, record);
  reader.require_end();
  return record;
}

}  // namespace mpm
