#pragma once

#include <memory>
#include <string>
#include <utility>

#include "results/archive/disk_file.hpp"
#include "results/archive/hdf5_handle.hpp"

namespace mpm::hdf5 {

/// The library keeps a file open as long as one of its groups is open. So the root group stands for the file.
struct GroupState {
  DiskError disk;  ///< error of a file written on the disk; closed with the last group
  Handle group;
  std::string file;
  std::string path;  ///< ends with "/"

  Place place(const char* what, const std::string& name) const { return {file, what, path, name}; }

  static std::shared_ptr<const GroupState> root_of(const Handle& file, const Place& place,
                                                   DiskError disk = {}) {
    return std::make_shared<const GroupState>(GroupState{
        std::move(disk), place.own(H5Gopen2(file.get(), "/", H5P_DEFAULT), H5Gclose, "open the root group"),
        place.file, place.parent});
  }
};

}  // namespace mpm::hdf5
