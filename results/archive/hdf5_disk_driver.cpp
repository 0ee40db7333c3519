#include "results/archive/hdf5_disk_driver.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <limits>
#include <memory>

#include "results/archive/disk_file.hpp"

namespace mpm::hdf5 {
namespace {

/// A DiskFile as the library sees it.
struct OpenDiskFile {
  H5FD_t base = {};  ///< first, as the library requires
  DiskFile disk;
  haddr_t end_of_allocation = 0, end_of_file = 0;

  static OpenDiskFile& of(H5FD_t* file) { return *reinterpret_cast<OpenDiskFile*>(file); }
  static const OpenDiskFile& of(const H5FD_t* file) { return *reinterpret_cast<const OpenDiskFile*>(file); }

  OpenDiskFile(const char* path, bool is_written, int* error)
      : disk(path, is_written, error), end_of_file(is_written || !disk.is_open() ? 0 : disk.size()) {}

  static H5FD_t* open(const char* name, unsigned flags, hid_t access, haddr_t) {
    auto* const error = *static_cast<int* const*>(H5Pget_driver_info(access));
    auto file = std::make_unique<OpenDiskFile>(name, (flags & H5F_ACC_RDWR) != 0, error);
    return file->disk.is_open() ? &file.release()->base : nullptr;
  }
  static herr_t close(H5FD_t* file) {
    const std::unique_ptr<OpenDiskFile> closed(&of(file));
    return 0;
  }
  static herr_t query(const H5FD_t*, unsigned long* flags) {
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
             H5FD_FEAT_AGGREGATE_SMALLDATA;
    return 0;
  }
  static haddr_t get_eoa(const H5FD_t* file, H5FD_mem_t) { return of(file).end_of_allocation; }
  static herr_t set_eoa(H5FD_t* file, H5FD_mem_t, haddr_t end) {
    of(file).end_of_allocation = end;
    return 0;
  }
  static haddr_t get_eof(const H5FD_t* file, H5FD_mem_t) { return of(file).end_of_file; }

  static herr_t read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t begin, std::size_t size, void* buffer) {
    OpenDiskFile& from = of(file);
    return from.disk.read(begin, {static_cast<char*>(buffer), size}) || from.disk.is_written() ? 0 : -1;
  }
  static herr_t write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t begin, std::size_t size, const void* buffer) {
    OpenDiskFile& to = of(file);
    to.disk.write(begin, {static_cast<const char*>(buffer), size});
    to.end_of_file = std::max<haddr_t>(to.end_of_file, begin + size);
    return 0;
  }
  static herr_t truncate(H5FD_t* file, hid_t, hbool_t) {
    OpenDiskFile& cut = of(file);
    if (cut.end_of_file != cut.end_of_allocation)
      cut.disk.truncate(cut.end_of_allocation);
    cut.end_of_file = cut.end_of_allocation;
    return 0;
  }
};

}  // namespace

hid_t disk_driver() {
  static const H5FD_class_t kClass = [] {
    H5FD_class_t driver{};
    driver.name = "mpmbench disk";
    driver.maxaddr = static_cast<haddr_t>(std::numeric_limits<off_t>::max());
    driver.fc_degree = H5F_CLOSE_WEAK;
    driver.fapl_size = sizeof(int*);
    driver.open = OpenDiskFile::open;
    driver.close = OpenDiskFile::close;
    driver.query = OpenDiskFile::query;
    driver.get_eoa = OpenDiskFile::get_eoa;
    driver.set_eoa = OpenDiskFile::set_eoa;
    driver.get_eof = OpenDiskFile::get_eof;
    driver.read = OpenDiskFile::read;
    driver.write = OpenDiskFile::write;
    driver.truncate = OpenDiskFile::truncate;
    constexpr H5FD_mem_t kMap[] = H5FD_FLMAP_DICHOTOMY;
    std::copy(std::begin(kMap), std::end(kMap), std::begin(driver.fl_map));
    return driver;
  }();
  static const hid_t kDriver = H5FDregister(&kClass);
  return kDriver;
}

}  // namespace mpm::hdf5
