#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace mpm {

/// The number of the first system error; 0 if there was none.
using DiskError = std::shared_ptr<int>;

/// A file on the disk that hides errors of writing and closing from its user. Data that cannot be written are
/// lost, and the number of the first error is stored where the creator of the file looks for it.
class DiskFile {
 public:
  /// Opens the file at `path`, which must exist; a file opened for writing is emptied. `error` must outlive
  /// the file.
  DiskFile(const char* path, bool is_written, int* error);
  DiskFile(const DiskFile&) = delete;
  DiskFile& operator=(const DiskFile&) = delete;
  ~DiskFile();

  /// If this is false, no other member may be called.
  bool is_open() const { return descriptor_ >= 0; }
  bool is_written() const { return is_written_; }
  /// Size in bytes; 0 if the system cannot tell it.
  std::uint64_t size() const;

  /// Fills `bytes` from position `begin` on, with zeros beyond the end of the file. After an error it fills
  /// the rest with zeros and returns false.
  bool read(std::uint64_t begin, std::span<char> bytes);
  /// Does nothing after an error.
  void write(std::uint64_t begin, std::span<const char> bytes);
  void truncate(std::uint64_t size);

 private:
  void note_error();

  bool is_written_;
  int descriptor_;
  int* error_;
};

}  // namespace mpm
