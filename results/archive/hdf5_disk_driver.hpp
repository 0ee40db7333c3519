#pragma once

#include <hdf5.h>

namespace mpm::hdf5 {

/// The driver of an archive on the disk (DiskFile), made or read, known to the library from the first call
/// on. Its info is an int*, where the number of the first error of the system is kept: the library crashes
/// when it ends with a file that it could not write or close, so that it hears of no such error.
hid_t disk_driver();

}  // namespace mpm::hdf5
