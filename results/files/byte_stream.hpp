#pragma once

#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include <Eigen/Core>

// Values as bytes that a process and its workers exchange. Both are the same program on the same machine, so
// every number keeps its bits. One list of members serves both directions: transfer(stream, value) writes a
// const value to a ByteWriter or reads a value from a ByteReader.

namespace mpm {

class ByteWriter {
 public:
  void block(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Throws std::runtime_error if there are too few bytes.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}
  void block(void* data, std::size_t size) {
    if (size > bytes_.size())
      throw std::runtime_error("message between processes: too few bytes");
    if (size > 0)
      std::memcpy(data, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }
  std::size_t left() const { return bytes_.size(); }
  /// Throws std::runtime_error if bytes are left over.
  void require_end() const {
    if (!bytes_.empty())
      throw std::runtime_error("message between processes: too many bytes");
  }

 private:
  std::string_view bytes_;
};

template <class Stream, class Value>
requires std::is_arithmetic_v<std::remove_const_t<Value>> || std::is_enum_v<std::remove_const_t<Value>>
void transfer(Stream& stream, Value& value) {
  if constexpr (std::is_same_v<Stream, ByteReader> && std::is_same_v<Value, bool>) {
    unsigned char byte = 0;  // a bool from a byte other than 0 or 1 is undefined
    stream.block(&byte, sizeof byte);
    if (byte > 1)
      throw std::runtime_error("message between processes: a flag that is neither 0 nor 1");
    value = byte == 1;
  } else {
    stream.block(&value, sizeof value);
  }
}

template <class Stream, class Text>
requires std::is_same_v<std::remove_const_t<Text>, std::string>
void transfer(Stream& stream, Text& text) {
  std::size_t size = text.size();
  stream.block(&size, sizeof size);
  if constexpr (!std::is_const_v<Text>) {
    if (size > stream.left())
      throw std::runtime_error("message between processes: too few bytes");
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
    using Plain = std::remove_const_t<Matrix>;  // without assertions, resize() does not check a fixed size
    if ((Plain::RowsAtCompileTime >= 0 && shape[0] != Plain::RowsAtCompileTime) ||
        (Plain::ColsAtCompileTime >= 0 && shape[1] != Plain::ColsAtCompileTime))
      throw std::runtime_error("message between processes: a matrix of another shape");
    const std::size_t most = stream.left() / sizeof(double);
    if (shape[0] < 0 || shape[1] < 0 ||
        (shape[0] > 0 && static_cast<std::size_t>(shape[1]) > most / static_cast<std::size_t>(shape[0])))
      throw std::runtime_error("message between processes: a matrix that does not fit");
    matrix.resize(shape[0], shape[1]);
  }
  stream.block(matrix.data(), static_cast<std::size_t>(matrix.size()) * sizeof(double));
}

/// Transfers the size of a list, and each element by `members(element)`.
template <class Stream, class List, class Members>
void transfer_list(Stream& stream, List& list, const Members& members) {
  std::size_t size = list.size();
  transfer(stream, size);
  if constexpr (!std::is_const_v<List>) {
    if (size > stream.left())  // each element has at least one byte
      throw std::runtime_error("message between processes: a list that does not fit");
    list.resize(size);
  }
  for (auto& element : list)
    members(element);
}

/// Transfers whether there is a value and, if so, the value by `members(value)`.
template <class Stream, class Optional, class Members>
void transfer_optional(Stream& stream, Optional& value, const Members& members) {
  bool present = value.has_value();
  transfer(stream, present);
  if constexpr (!std::is_const_v<Optional>) {
    if (present)
      value.emplace();
  }
  if (present)
    members(*value);
}

/// Transfers all `values`, one after the other.
template <class Stream, class... Values>
void transfer_all(Stream& stream, Values&... values) {
  (transfer(stream, values), ...);
}

}  // namespace mpm
