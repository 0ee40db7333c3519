#pragma once

#include <filesystem>

#include "base/system/temporary_folder.hpp"
#include "plants/outside/fmu_description.hpp"

namespace mpm {

/// An FMU, unpacked into a folder of its own that is removed with this object: its library for this platform
/// and its resources.
class FmuPackage {
 public:
  /// Errors: InputError if the file cannot be read, is no ZIP, holds a path that leads out of it or has no
  /// library for 64-bit Linux; also as parse_fmu_description().
  explicit FmuPackage(const std::filesystem::path& file);

  const FmuDescription& description() const { return description_; }
  /// binaries/linux64/IDENTIFIER.so, by FMI 3.0 binaries/x86_64-linux/IDENTIFIER.so. If there is no such
  /// file, the only library in this folder, whatever its name is.
  std::filesystem::path library() const;
  /// The URI of the folder resources, by FMI 3.0 its path, as the library takes it.
  std::string resources() const;

 private:
  TemporaryFolder folder_;
  FmuDescription description_;
};

}  // namespace mpm
