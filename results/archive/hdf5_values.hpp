#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "results/archive/hdf5_handle.hpp"
#include "results/files/utf8.hpp"

// Converts values of the types in our files between the HDF5 library and memory.

namespace mpm::hdf5 {

using Shape = std::vector<hsize_t>;

/// Returns how many values a shape holds; 1 if it has no dimensions.
std::size_t product(const Shape& shape);

Handle make_space(const Place& place, const Shape& shape);
Shape shape_of_space(const Place& place, hid_t space);

/// The type of UTF-8 texts of any length.
Handle string_type(const Place& place);

/// The type of T in a file.
template <class T>
Handle type_of(const Place& place) {
  if constexpr (std::is_same_v<T, std::string>)
    return string_type(place);
  const hid_t type = std::is_same_v<T, double>          ? H5T_IEEE_F64LE
                     : std::is_same_v<T, std::int8_t>   ? H5T_STD_I8LE
                     : std::is_same_v<T, std::int32_t>  ? H5T_STD_I32LE
                     : std::is_same_v<T, std::int64_t>  ? H5T_STD_I64LE
                     : std::is_same_v<T, std::uint64_t> ? H5T_STD_U64LE
                                                        : H5I_INVALID_HID;
  return place.own(H5Tcopy(type), H5Tclose, "make a type");
}

/// Throws ArchiveError unless `found` is the type of T in a file.
template <class T>
void require_type(const Place& place, hid_t found) {
  bool same = false;
  if constexpr (std::is_same_v<T, std::string>)
    same = H5Tget_class(found) == H5T_STRING && H5Tis_variable_str(found) > 0;
  else
    same = H5Tequal(found, type_of<T>(place).get()) > 0;
  if (!same)
    place.fail("another type of values than expected");
}

/// Calls write(buffer) with the values in the form that the library expects.
template <class T, class Write>
void with_buffer(const std::vector<T>& values, Write write) {
  if constexpr (std::is_same_v<T, std::string>) {
    std::vector<std::string> texts(values.size());
    std::transform(values.begin(), values.end(), texts.begin(), proper_utf8);
    std::vector<const char*> pointers(values.size());
    std::transform(texts.begin(), texts.end(), pointers.begin(),
                   [](const std::string& text) { return text.c_str(); });
    write(pointers.data());
  } else {
    write(values.data());
  }
}

/// Returns `count` values that read(buffer) gets from the library. The library may allocate memory for them,
/// which is freed here.
template <class T, class Read>
std::vector<T> from_buffer(std::size_t count, hid_t type, hid_t space, Read read) {
  if constexpr (std::is_same_v<T, std::string>) {
    struct Texts {
      hid_t type, space;
      std::vector<char*> pointers;
      ~Texts() { H5Dvlen_reclaim(type, space, H5P_DEFAULT, pointers.data()); }
    } texts{type, space, std::vector<char*>(count, nullptr)};
    read(texts.pointers.data());
    std::vector<std::string> values(count);
    std::transform(texts.pointers.begin(), texts.pointers.end(), values.begin(),
                   [](const char* text) { return text == nullptr ? std::string() : std::string(text); });
    return values;
  } else {
    std::vector<T> values(count);
    read(values.data());
    return values;
  }
}

}  // namespace mpm::hdf5
