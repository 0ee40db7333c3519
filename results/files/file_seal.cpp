#include "results/files/file_seal.hpp"

#include <algorithm>
#include <fstream>
#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "base/sha256.hpp"
#include "results/files/archive_error.hpp"

namespace mpm {
namespace {

constexpr std::string_view kSealBegin = "\nmpmbench sha256 ";
constexpr std::string_view kSealEnd = "\n";
constexpr std::string_view kHdf5Signature = "\x89HDF\r\n\x1A\n";
constexpr std::size_t kHashDigits = 64;
static_assert(kSealBytes == kSealBegin.size() + kHashDigits + kSealEnd.size());

bool is_seal(std::string_view text) {
  return text.size() == kSealBytes && text.starts_with(kSealBegin) && text.ends_with(kSealEnd);
}

/// A file that is read piece by piece.
class InputFile {
 public:
  explicit InputFile(const std::filesystem::path& path) : name_(path.string()) {
    std::error_code error;
    if (!std::filesystem::exists(path, error))
      refuse("no such file");
    if (!std::filesystem::is_regular_file(path, error))
      refuse("a folder or a device, not an HDF5 file");
    size_ = static_cast<std::size_t>(std::filesystem::file_size(path, error));
    file_.open(path, std::ios::binary);
    if (error || !file_)
      refuse("cannot be read");
  }

  std::size_t size() const { return size_; }
  [[noreturn]] void refuse(const char* why) const { throw ArchiveError(fmt::format("{}: {}", name_, why)); }

  /// Reads `length` bytes from `begin` on, or as many as there are.
  template <class Bytes>
  Bytes read(std::size_t begin, std::size_t length) {
    Bytes bytes(std::min(length, size_ - std::min(begin, size_)), typename Bytes::value_type{});
    file_.seekg(static_cast<std::streamoff>(begin));
    file_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!file_)
      refuse("cannot be read to its end");
    return bytes;
  }

 private:
  std::string name_;
  std::size_t size_ = 0;
  std::ifstream file_;
};

/// Returns the SHA-256 of the first `size` bytes of the file.
std::string sha256_of(InputFile& file, std::size_t size) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  Sha256 hash;
  for (std::size_t begin = 0; begin < size; begin += kPiece)
    hash.add(file.read<std::vector<std::byte>>(begin, std::min(kPiece, size - begin)));
  return hash.digits();
}

std::string seal_of(const std::string& hash) {
  return fmt::format("{}{}{}", kSealBegin, hash, kSealEnd);
}

constexpr const char* kDamaged =
    "the file is damaged: its SHA-256 differs from the one at its end; restore a copy, or run the study "
    "again";

/// Returns the hash in the seal at the end of the file. Refuses a file without one.
std::string read_seal(InputFile& file) {
  const std::size_t begin = file.size() - std::min(file.size(), kSealBytes);
  const auto seal = file.read<std::string>(begin, kSealBytes);
  if (is_seal(seal))
    return seal.substr(kSealBegin.size(), kHashDigits);
  if (file.read<std::string>(0, kHdf5Signature.size()) != kHdf5Signature)
    file.refuse("not an HDF5 file, or not a whole one");
  file.refuse(
      "no checksum at its end: the file is not a whole one, was changed by another program, or comes from an "
      "early version of mpmbench; restore a copy, or run the study again");
}

}  // namespace

std::vector<std::byte> sealed(std::vector<std::byte> content) {
  const std::string seal = seal_of(sha256(content));
  const auto bytes = std::as_bytes(std::span(seal));
  content.insert(content.end(), bytes.begin(), bytes.end());
  return content;
}

std::optional<std::string_view> unsealed(std::string_view file) {
  const std::string_view content = file.substr(0, file.size() - std::min(file.size(), kSealBytes));
  const std::string_view seal = file.substr(content.size());
  if (!is_seal(seal) ||
      seal.substr(kSealBegin.size(), kHashDigits) != sha256(std::as_bytes(std::span(content))))
    return std::nullopt;
  return content;
}

std::vector<std::byte> read_sealed_file(const std::filesystem::path& path) {
  InputFile file(path);
  const std::string hash = read_seal(file);  // first: a file without a seal may be too large for the memory
  auto content = file.read<std::vector<std::byte>>(0, file.size() - kSealBytes);
  if (sha256(content) != hash)
    file.refuse(kDamaged);
  return content;
}

void require_seal(const std::filesystem::path& path) {
  InputFile file(path);
  const std::string hash = read_seal(file);
  if (sha256_of(file, file.size() - kSealBytes) != hash)
    file.refuse(kDamaged);
}

void seal_file(const std::filesystem::path& path) {
  InputFile file(path);
  const std::string seal = seal_of(sha256_of(file, file.size()));
  std::ofstream end(path, std::ios::binary | std::ios::app);
  end << seal << std::flush;
  if (!end)
    file.refuse("cannot write its checksum");
}

}  // namespace mpm
