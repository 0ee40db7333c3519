#include "results/archive/hdf5_file.hpp"

#include <system_error>

#include <fmt/format.h>
#include <hdf5_hl.h>

#include "results/archive/hdf5_dataset.hpp"
#include "results/archive/hdf5_disk_driver.hpp"
#include "results/archive/hdf5_group_state.hpp"
#include "results/files/archive_error.hpp"
#include "results/files/file_seal.hpp"

namespace mpm {
namespace {

/// Sets the format of HDF5 1.8 at most, which netCDF-4 can read. In this format tracked objects have
/// checksums. The superblock must be of the earliest version: H5Fget_file_image (1.10.8) breaks the checksum
/// of a later one, because it resets a flag that the checksum covers. The library locks no file: our files
/// are locked by other means, or are where nobody can lock.
hdf5::Handle file_access(const hdf5::Place& place) {
  hdf5::Handle access = place.own(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "make properties");
  place.check(H5Pset_libver_bounds(access.get(), H5F_LIBVER_EARLIEST, H5F_LIBVER_V18), "make properties");
  place.check(H5Pset_file_locking(access.get(), false, true), "make properties");
  return access;
}

hdf5::Handle memory_access(const hdf5::Place& place) {
  constexpr std::size_t kGrowth = std::size_t{1} << 22;
  hdf5::Handle access = file_access(place);
  place.check(H5Pset_fapl_core(access.get(), kGrowth, false), "make properties");
  return access;
}

/// Opens files through our own driver: otherwise the library crashes at exit if a file could not be written
/// or closed. The first error is stored in `error`, which must outlive the file.
hdf5::Handle disk_access(const hdf5::Place& place, int& error) {
  hdf5::Handle access = file_access(place);
  int* const kept = &error;
  place.check(H5Pset_driver(access.get(), hdf5::disk_driver(), &kept), "make properties");
  return access;
}

/// Creates a file at `path`; if `access` keeps the file in memory, `path` is only a name.
hdf5::Handle create_file(const hdf5::Place& place, const std::string& path, const hdf5::Handle& access) {
  const hdf5::Handle creation = place.own(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "make properties");
  set_group_properties(place, creation.get());
  return place.own(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose,
                   "create the file");
}

}  // namespace

Hdf5File Hdf5File::create(const std::string& name) {
  hdf5::silence_library();
  const hdf5::Place place{name, "group", "/", ""};
  return Hdf5File(Hdf5Group::State::root_of(create_file(place, name, memory_access(place)), place));
}

Hdf5File Hdf5File::create_at(const std::filesystem::path& path, const std::string& name) {
  hdf5::silence_library();
  const hdf5::Place place{name, "group", "/", ""};
  auto disk = std::make_shared<int>(0);
  const hdf5::Handle access = disk_access(place, *disk);
  return Hdf5File(
      Hdf5Group::State::root_of(create_file(place, path.string(), access), place, std::move(disk)));
}

Hdf5File Hdf5File::open(const std::filesystem::path& path) {
  require_seal(path);
  hdf5::silence_library();
  const hdf5::Place place{path.string(), "group", "/", ""};
  auto disk = std::make_shared<int>(0);
  const hdf5::Handle access = disk_access(place, *disk);  // stays open until the error is read
  const hdf5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
  if (file.get() < 0)
    throw ArchiveError(
        fmt::format("{}: not an HDF5 file, or not a whole one{}", place.file, hdf5::last_error()));
  return Hdf5File(Hdf5Group::State::root_of(file, place, std::move(disk)));
}

Hdf5File Hdf5File::open_unsealed(std::vector<std::byte> content, const std::string& name) {
  hdf5::silence_library();
  const hdf5::Place place{name, "group", "/", ""};
  constexpr unsigned kReadOnlyCopy = 0;
  const hdf5::Handle file(H5LTopen_file_image(content.data(), content.size(), kReadOnlyCopy), H5Fclose);
  if (file.get() < 0)
    throw ArchiveError(fmt::format("{}: not an HDF5 file, or not a whole one{}", name, hdf5::last_error()));
  return Hdf5File(Hdf5Group::State::root_of(file, place));
}

Hdf5Group Hdf5File::root() const {
  return Hdf5Group(root_);
}

void Hdf5File::finish() const {
  const hdf5::Place place = root_->place("group", "");
  place.check(H5Fflush(root_->group.get(), H5F_SCOPE_GLOBAL), "finish the file");
  if (root_->disk && *root_->disk != 0)
    throw ArchiveError(fmt::format("{}: cannot write: {}", place.file,
                                   std::error_code(*root_->disk, std::generic_category()).message()));
}

std::vector<std::byte> Hdf5File::image() const {
  const hdf5::Place place = root_->place("group", "");
  const hdf5::Handle file = place.own(H5Iget_file_id(root_->group.get()), H5Fclose, "find its file");
  place.check(H5Fflush(file.get(), H5F_SCOPE_GLOBAL), "finish the file");
  const ssize_t size = H5Fget_file_image(file.get(), nullptr, 0);
  place.check(size < 0 ? -1 : 0, "measure the file");
  std::vector<std::byte> bytes(static_cast<std::size_t>(size));
  place.check(H5Fget_file_image(file.get(), bytes.data(), bytes.size()) < 0 ? -1 : 0, "copy the file");
  return sealed(std::move(bytes));
}

}  // namespace mpm
