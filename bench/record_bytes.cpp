#include "bench/record_bytes.hpp"

#include "bench/byte_stream.hpp"
#include "bench/draw_bytes.hpp"

namespace mpm {
namespace {

template <class Stream, class Record>
void transfer_record(Stream& stream, Record& record) {
  const auto all = [&stream](auto&... values) { transfer_all(stream, values...); };
  all(record.draw.index, record.status, record.message);
  transfer_draw(stream, record.draw);
  auto& diagnosis = record.diagnosis;
  all(diagnosis.ivar, diagnosis.ivar_diag, diagnosis.ivar_basis, diagnosis.impactful, diagnosis.predicted_cv,
      diagnosis.predicted_source);
  const auto indicators = [&](auto& i) {
    all(i.co_dkts, i.co_dskn, i.i_mpm, i.co_kts, i.co_skn, i.scanned, i.used);
  };
  indicators(diagnosis.indicator);
  transfer_list(stream, diagnosis.cvs, [&](auto& cv) {
    all(cv.flagged, cv.source, cv.sse);
    indicators(cv.indicator);
  });
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
