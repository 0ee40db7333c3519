#include "results/archive/hdf5_values.hpp"

#include <functional>
#include <numeric>

namespace mpm::hdf5 {

std::size_t product(const Shape& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
}

Handle make_space(const Place& place, const Shape& shape) {
  return place.own(shape.empty() ? H5Screate(H5S_SCALAR)
                                 : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                   H5Sclose, "make a space");
}

Shape shape_of_space(const Place& place, hid_t space) {
  const int rank = H5Sget_simple_extent_ndims(space);
  place.check(rank, "read the shape");
  Shape shape(static_cast<std::size_t>(rank));
  place.check(H5Sget_simple_extent_dims(space, shape.data(), nullptr), "read the shape");
  return shape;
}

Handle string_type(const Place& place) {
  Handle type = place.own(H5Tcopy(H5T_C_S1), H5Tclose, "make a type");
  place.check(H5Tset_size(type.get(), H5T_VARIABLE), "make a type");
  place.check(H5Tset_cset(type.get(), H5T_CSET_UTF8), "make a type");
  return type;
}

}  // namespace mpm::hdf5
