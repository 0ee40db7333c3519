#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace mpm {

/// The number of the first error of the system, 0 before.
using DiskError = std::shared_ptr<int>;

/// A file on the disk that hides errors of writing and closing from its user: what cannot be written is lost,
/// and the number of the first error is kept where the maker of the file looks for it.
class DiskFile {
 public:
  /// The file at `path`, which must be there: to be written, it is emptied. `error` outlives the file.
  DiskFile(const char* path, bool is_written, int* error);
  DiskFile(const DiskFile&) = delete;
  DiskFile& operator=(const DiskFile&) = delete;
  ~DiskFile();

  /// Nothing but this may be asked of a file that could not be opened.
  bool is_open() const { return descriptor_ >= 0; }
  bool is_written() const { return is_written_; }
  /// Bytes; 0 of a file that cannot be looked at.
  std::uint64_t size() const;

  /// Fills `bytes` from the place `begin` on; with zeros beyond the end, and after an error, when it returns
  /// false.
  bool read(std::uint64_t begin, std::span<char> bytes);
  /// Does nothing once there was an error.
  void write(std::uint64_t begin, std::span<const char> bytes);
  void truncate(std::uint64_t size);

 private:
  void note_error();

  bool is_written_;
  int descriptor_;
  int* error_;
};

}  // namespace mpm
