#include "plants/outside/fmu_package.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <zip.h>

#include "base/error.hpp"
#include "base/system/foreign_text.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

constexpr const char *kBinaries2 = "binaries/linux64/", *kBinaries3 = "binaries/x86_64-linux/";
constexpr const char* kResources = "resources/";
constexpr std::uint64_t kMostBytes = std::uint64_t{4} << 30U;  // unpacked: a bound on what a file can cost
constexpr std::uint64_t kMostOfDescription = std::uint64_t{256} << 20U;  // read into memory as a whole
constexpr std::size_t kEntryPiece = std::size_t{1} << 16;
constexpr std::size_t kShownOfEntry = 100;  // bytes of a name, in a message

struct CloseZip {
  void operator()(zip_t* zip) const { zip_discard(zip); }
};
using Zip = std::unique_ptr<zip_t, CloseZip>;

Zip open_zip(const fs::path& file) {
  int code = 0;
  Zip zip(zip_open(file.c_str(), ZIP_RDONLY, &code));
  if (zip)
    return zip;
  zip_error_t error;
  zip_error_init_with_code(&error, code);
  const std::string text = zip_error_strerror(&error);
  zip_error_fini(&error);
  throw InputError("FMU", fmt::format("'{}' ({})", file.string(), text), "an FMU: a ZIP file");
}

/// Passes the content of one entry on in pieces, as many bytes as the file declares.
void read_entry(zip_t* zip, const zip_stat_t& entry, const fs::path& file,
                const std::function<void(std::string_view)>& take) {
  struct CloseEntry {
    void operator()(zip_file_t* open) const { zip_fclose(open); }
  };
  const std::unique_ptr<zip_file_t, CloseEntry> open(zip_fopen_index(zip, entry.index, 0));
  std::vector<char> piece(kEntryPiece);
  for (std::uint64_t left = entry.size; left > 0;) {
    const zip_int64_t got =
        open ? zip_fread(open.get(), piece.data(), std::min<std::uint64_t>(left, piece.size())) : -1;
    if (got <= 0)
      throw InputError(fmt::format("{}: entry '{}'", file.string(), foreign_text(entry.name, kShownOfEntry)),
                       open ? zip_file_strerror(open.get()) : zip_strerror(zip), "an entry that can be read");
    take({piece.data(), static_cast<std::size_t>(got)});
    left -= static_cast<std::uint64_t>(got);
  }
}

const char* binaries_of(const FmuDescription& fmu) {
  return fmu.version == FmiVersion::two ? kBinaries2 : kBinaries3;
}

bool is_wanted(const std::string& name) {
  return name.starts_with(kBinaries2) || name.starts_with(kBinaries3) || name.starts_with(kResources);
}

/// Does the path stay in the folder that it is put in?
bool stays_inside(const fs::path& path) {
  for (const fs::path& part : path)
    if (part == "..")
      return false;
  return path.is_relative();
}

/// Throws InputError where another entry is in the way, std::system_error when there is no room.
void write_entry(zip_t* zip, const zip_stat_t& entry, const fs::path& file, const fs::path& path) {
  std::error_code in_the_way;
  fs::create_directories(path.parent_path(), in_the_way);
  std::ofstream stream(path, std::ios::binary);
  if (in_the_way || !stream)
    throw InputError(fmt::format("{}: entry '{}'", file.string(), foreign_text(entry.name, kShownOfEntry)),
                     "a path that cannot be made", "files in folders");
  read_entry(zip, entry, file, [&stream](std::string_view piece) {
    stream.write(piece.data(), static_cast<std::streamsize>(piece.size()));
  });
  if (!stream.flush())
    throw std::system_error(errno, std::generic_category(), path.string());
}

/// Checks the sizes that the file claims before any of it is unpacked.
void require_bounds(const zip_stat_t& entry, bool is_description, std::uint64_t bytes, const fs::path& file) {
  const std::uint64_t most = is_description ? kMostOfDescription : kMostBytes;
  if (entry.size > most || bytes > kMostBytes)
    throw InputError(fmt::format("{}: entry '{}'", file.string(), foreign_text(entry.name, kShownOfEntry)),
                     fmt::format("{} bytes", entry.size),
                     fmt::format("at most {}, and {} of the whole file", most, kMostBytes));
}

/// Unpacks what is needed; returns the text of modelDescription.xml.
std::string unpack(const fs::path& file, const fs::path& folder) {
  const Zip zip = open_zip(file);
  std::string description;
  std::uint64_t bytes = 0;
  const zip_int64_t entries = zip_get_num_entries(zip.get(), 0);
  for (zip_uint64_t index = 0; index < static_cast<zip_uint64_t>(entries); ++index) {
    zip_stat_t stat;
    zip_stat_init(&stat);
    if (zip_stat_index(zip.get(), index, 0, &stat) != 0 || stat.name == nullptr)
      continue;
    stat.index = index;
    const std::string name = stat.name;
    const bool is_description = name == "modelDescription.xml";
    if (!is_description && (!is_wanted(name) || name.ends_with('/')))
      continue;
    require_bounds(stat, is_description, stat.size > kMostBytes ? stat.size : bytes += stat.size, file);
    if (is_description) {
      description.clear();
      read_entry(zip.get(), stat, file, [&description](std::string_view piece) { description += piece; });
      continue;
    }
    if (!stays_inside(name))
      throw InputError(fmt::format("{}: entry '{}'", file.string(), foreign_text(name, kShownOfEntry)),
                       "a path out of the file", "paths inside");
    write_entry(zip.get(), stat, file, folder / name);
  }
  if (description.empty())
    throw InputError("FMU", fmt::format("'{}' without modelDescription.xml", file.string()), "an FMU");
  return description;
}

}  // namespace

FmuPackage::FmuPackage(const fs::path& file) {
  fs::create_directories(folder_.path() / kResources);
  description_ = parse_fmu_description(unpack(file, folder_.path()), file.string());
  if (!fs::is_regular_file(library()))
    throw InputError(fmt::format("{}: library", file.string()), "none for this platform",
                     fmt::format("{}{}.so; export it for 64-bit Linux", binaries_of(description_),
                                 description_.identifier));
}

fs::path FmuPackage::library() const {
  const fs::path folder = folder_.path() / binaries_of(description_);
  fs::path named = folder / (description_.identifier + ".so");
  std::error_code none;
  if (fs::is_regular_file(named, none))
    return named;
  std::vector<fs::path> others;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
    if (entry.path().extension() == ".so")
      others.push_back(entry.path());
  return others.size() == 1 ? others.front() : named;
}

std::string FmuPackage::resources() const {
  return description_.version == FmiVersion::two
             ? fmt::format("file://{}", (folder_.path() / "resources").string())
             : (folder_.path() / kResources).string();
}

}  // namespace mpm
