#include "bench/record_bytes.hpp"

#include <bit>
#include <cstdint>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "bench/byte_stream.hpp"
#include "bench/draw_bytes.hpp"

namespace mpm {
namespace {

/// Puts a number of a message back. Throws std::runtime_error for one that is none of the column's: a verdict
/// without a word, or a number that does not come back as it was.
template <class Owner>
void put_back(const NumberColumn<Owner>& column, Owner& owner, double value) {
  const bool verdict = !column.words.empty();
  if (verdict && !(value >= 0.0 && value < static_cast<double>(column.words.size())))
    throw std::runtime_error("message between processes: " + column.name + " is none of its verdicts");
  column.set(owner, value);
  if (std::bit_cast<std::uint64_t>(column.value(owner)) != std::bit_cast<std::uint64_t>(value))
    throw std::runtime_error("message between processes: " + column.name + " is none of its numbers");
}

/// Every number of a table of columns.
template <class Stream, class Owner>
void transfer_numbers(Stream& stream, Owner& owner,
                      const std::vector<NumberColumn<std::remove_const_t<Owner>>>& columns) {
  for (const auto& column : columns) {
    double value = column.value(owner);
    transfer(stream, value);
    if constexpr (!std::is_const_v<Owner>)
      put_back(column, owner, value);
  }
}

template <class Stream, class Cv>
void transfer_cv(Stream& stream, Cv& cv) {
  transfer_all(stream, cv.flagged, cv.source, cv.sse, cv.distribution.mpm.scanned, cv.distribution.mpm.used);
  transfer_numbers(stream, cv.distribution, distribution_columns());
  transfer_numbers(stream, cv.distribution, scatter_columns());
  transfer_numbers(stream, cv.acf, acf_columns());
  transfer_all(stream, cv.acf.y.values, cv.acf.y0.values, cv.acf.y0_diag.values);
}

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
  transfer_list(stream, diagnosis.cvs, [&](auto& cv) { transfer_cv(stream, cv); });
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
