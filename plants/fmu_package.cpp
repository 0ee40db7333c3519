#include "plants/fmu_package.hpp"

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <zip.h>

#include "plants/error.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBinaries = "binaries/linux64/";
constexpr const char* kResources = "resources/";
constexpr std::uint64_t kMostBytes = std::uint64_t{4} << 30U;  // unpacked: a bound on what a file can cost

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

/// The content of one entry of the file.
std::string content_of(zip_t* zip, zip_uint64_t index, std::uint64_t size, const fs::path& file) {
  if (size > kMostBytes)
    throw InputError(fmt::format("{}: size of an entry", file.string()), fmt::format("{} bytes", size),
                     fmt::format("at most {}", kMostBytes));
  struct CloseEntry {
    void operator()(zip_file_t* entry) const { zip_fclose(entry); }
  };
  const std::unique_ptr<zip_file_t, CloseEntry> entry(zip_fopen_index(zip, index, 0));
  std::string content(size, '\0');
  if (!entry || zip_fread(entry.get(), content.data(), size) != static_cast<zip_int64_t>(size))
    throw InputError(fmt::format("{}: entry {}", file.string(), index), zip_strerror(zip),
                     "an entry that can be read");
  return content;
}

bool is_wanted(const std::string& name) {
  return name.starts_with(kBinaries) || name.starts_with(kResources);
}

/// Does the path stay in the folder that it is put in?
bool stays_inside(const fs::path& path) {
  for (const fs::path& part : path)
    if (part == "..")
      return false;
  return path.is_relative();
}

void write_file(const fs::path& path, const std::string& content) {
  fs::create_directories(path.parent_path());
  std::ofstream stream(path, std::ios::binary);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  if (!stream.flush())
    throw std::system_error(errno, std::generic_category(), path.string());
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
    const std::string name = stat.name;
    if (name == "modelDescription.xml")
      description = content_of(zip.get(), index, stat.size, file);
    if (!is_wanted(name) || name.ends_with('/'))
      continue;
    bytes += stat.size;
    if (!stays_inside(name) || bytes > kMostBytes)
      throw InputError(fmt::format("{}: entry '{}'", file.string(), name),
                       bytes > kMostBytes ? "too much" : "a path out of the file",
                       fmt::format("paths inside, at most {} bytes", kMostBytes));
    write_file(folder / name, content_of(zip.get(), index, stat.size, file));
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
                     fmt::format("{}{}.so; export it for 64-bit Linux", kBinaries, description_.identifier));
}

fs::path FmuPackage::library() const {
  return folder_.path() / kBinaries / (description_.identifier + ".so");
}

std::string FmuPackage::resources() const {
  return fmt::format("file://{}", (folder_.path() / "resources").string());
}

}  // namespace mpm
