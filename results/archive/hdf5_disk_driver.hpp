#pragma once

#include <hdf5.h>

namespace mpm::hdf5 {

/// The HDF5 driver of an archive on the disk (DiskFile), for writing and reading. The first call registers it
/// with the library. Its info is an int* that receives the number of the first system error. The driver hides
/// such errors from the library, because the library crashes at exit if it could not write or close a file.
hid_t disk_driver();

}  // namespace mpm::hdf5
