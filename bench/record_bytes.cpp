#include "bench/record_bytes.hpp"

#include <cstring>
#include <optional>
#include <stdexcept>
#include <type_traits>

namespace mpm {
namespace {

class Writer {
 public:
  void block(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}
  void block(void* data, std::size_t size) {
    if (size > bytes_.size())
      throw std::runtime_error("experiment record: too few bytes");
    if (size > 0)
      std::memcpy(data, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }
  bool empty() const { return bytes_.empty(); }
  std::size_t left() const { return bytes_.size(); }

 private:
  std::string_view bytes_;
};

// One list of members serves both directions: `Stream` is a Writer, with const values, or a Reader.

template <class Stream, class Value>
requires std::is_arithmetic_v<std::remove_const_t<Value>> || std::is_enum_v<std::remove_const_t<Value>>
void transfer(Stream& stream, Value& value) {
  stream.block(&value, sizeof value);
}

template <class Stream, class Text>
requires std::is_same_v<std::remove_const_t<Text>, std::string>
void transfer(Stream& stream, Text& text) {
  std::size_t size = text.size();
  stream.block(&size, sizeof size);
  if constexpr (!std::is_const_v<Text>) {
    if (size > stream.left())
      throw std::runtime_error("experiment record: too few bytes");
    text.resize(size);
  }
  stream.block(text.data(), size);
}

template <class Stream, class Matrix>
requires std::is_base_of_v<Eigen::EigenBase<std::remove_const_t<Matrix>>, std::remove_const_t<Matrix>>
void transfer(Stream& stream, Matrix& matrix) {
  Eigen::Index shape[2] = {matrix.rows(), matrix.cols()};
  stream.block(shape, sizeof shape);
  if constexpr (!std::is_const_v<Matrix>) {
    const std::size_t most = stream.left() / sizeof(double);
    if (shape[0] < 0 || shape[1] < 0 ||
        (shape[0] > 0 && static_cast<std::size_t>(shape[1]) > most / static_cast<std::size_t>(shape[0])))
      throw std::runtime_error("experiment record: a matrix that does not fit");
    matrix.resize(shape[0], shape[1]);
  }
  stream.block(matrix.data(), static_cast<std::size_t>(matrix.size()) * sizeof(double));
}

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
  const auto all = [&stream](auto&... values) { (transfer(stream, values), ...); };
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
  const auto statistics = [&](auto& s) { all(s.steps, s.iterations, s.largest_kkt_residual); };
  statistics(record.solver);
  transfer_optional(stream, record.loop, [&](auto& loop) {
    all(loop.trajectory.status, loop.trajectory.samples_done, loop.trajectory.y, loop.trajectory.u,
        loop.trajectory.u_target, loop.trajectory.d, loop.y_sim);
    statistics(loop.trajectory.solver);
  });
}

}  // namespace

std::string to_bytes(const ExperimentRecord& record) {
  Writer writer;
  transfer_record(writer, record);
  return writer.take();
}

ExperimentRecord record_from_bytes(std::string_view bytes) {
  Reader reader(bytes);
  ExperimentRecord record;
  transfer_record(reader, record);
  if (!reader.empty())
    throw std::runtime_error("experiment record: too many bytes");
  return record;
}

}  // namespace mpm
