#include "results/archive/disk_file.hpp"

#include <algorithm>
#include <cerrno>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace mpm {

DiskFile::DiskFile(const char* path, bool is_written, int* error)
    : is_written_(is_written),
      descriptor_(::open(path, (is_written ? O_RDWR | O_TRUNC : O_RDONLY) | O_CLOEXEC)),
      error_(error) {}

DiskFile::~DiskFile() {
  if (is_open() && ::close(descriptor_) != 0)
    note_error();
}

std::uint64_t DiskFile::size() const {
  struct ::stat status {};
  return ::fstat(descriptor_, &status) == 0 ? static_cast<std::uint64_t>(status.st_size) : 0;
}

bool DiskFile::read(std::uint64_t begin, std::span<char> bytes) {
  std::size_t done = 0;
  bool good = true;
  while (done < bytes.size()) {
    const ssize_t got =
        ::pread(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(begin + done));
    if (got < 0 && errno == EINTR)
      continue;
    if (got < 0) {
      note_error();
      good = false;
    }
    if (got <= 0)
      break;
    done += static_cast<std::size_t>(got);
  }
  std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(done), bytes.end(), '\0');
  return good;
}

void DiskFile::write(std::uint64_t begin, std::span<const char> bytes) {
  for (std::size_t done = 0; done < bytes.size() && *error_ == 0;) {
    const ssize_t put =
        ::pwrite(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(begin + done));
    if (put < 0 && errno != EINTR)
      note_error();
    done += put < 0 ? 0 : static_cast<std::size_t>(put);
  }
}

void DiskFile::truncate(std::uint64_t size) {
  if (::ftruncate(descriptor_, static_cast<off_t>(size)) != 0)
    note_error();
}

void DiskFile::note_error() {
  if (*error_ == 0)
    *error_ = errno;
}

}  // namespace mpm
