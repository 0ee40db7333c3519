#include "results/archive/hdf5_dataset.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <string>
#include <type_traits>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/non_finite.hpp"

namespace mpm::hdf5 {
namespace {

constexpr unsigned kTrackOrder = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;
constexpr double kFillValue = kNaN;
constexpr std::size_t kCompressFromBytes = 4096;
constexpr unsigned kCompressionLevel = 4;

template <class T>
void write_attribute_values(const Place& place, hid_t object, const Shape& shape,
                            const std::vector<T>& values) {
  const Handle type = type_of<T>(place);
  const Handle space = make_space(place, shape);
  const Handle attribute =
      place.own(H5Acreate2(object, place.name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                H5Aclose, "create it");
  if (!values.empty())
    with_buffer(values, [&](const void* buffer) {
      place.check(H5Awrite(attribute.get(), type.get(), buffer), "write it");
    });
}

template <class T>
Handle creation_properties(const Place& place, const Shape& shape, bool fill) {
  Handle properties = place.own(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "make properties");
  const hid_t id = properties.get();
  place.check(H5Pset_obj_track_times(id, false), "make properties");
  place.check(H5Pset_attr_creation_order(id, kTrackOrder), "make properties");
  // Texts are stored apart from the variable, where compression does not reach.
  if (!std::is_same_v<T, std::string> && !shape.empty() && product(shape) * sizeof(T) >= kCompressFromBytes) {
    const Shape chunk = chunk_shape(shape);
    place.check(H5Pset_chunk(id, static_cast<int>(chunk.size()), chunk.data()), "make properties");
    place.check(H5Pset_shuffle(id), "make properties");
    place.check(H5Pset_deflate(id, kCompressionLevel), "make properties");
  }
  if (fill)
    place.check(H5Pset_fill_value(id, H5T_NATIVE_DOUBLE, &kFillValue), "make properties");
  return properties;
}

}  // namespace

void write_attribute(const Place& place, hid_t object, const AttributeValue& value) {
  std::visit(
      [&]<class V>(const V& v) {
        if constexpr (std::is_arithmetic_v<V> || std::is_same_v<V, std::string>)
          write_attribute_values<V>(place, object, {}, {v});
        else
          write_attribute_values(place, object, {v.size()}, v);
      },
      value);
}

template <class T>
std::vector<T> read_attribute(const Place& place, hid_t object) {
  if (H5Aexists(object, place.name.c_str()) <= 0)
    place.fail("missing");
  const Handle attribute = place.own(H5Aopen(object, place.name.c_str(), H5P_DEFAULT), H5Aclose, "open it");
  const Handle type = place.own(H5Aget_type(attribute.get()), H5Tclose, "read its type");
  require_type<T>(place, type.get());
  const Handle space = place.own(H5Aget_space(attribute.get()), H5Sclose, "read its shape");
  const std::size_t count = product(shape_of_space(place, space.get()));
  return from_buffer<T>(count, type.get(), space.get(), [&](void* buffer) {
    if (count > 0)
      place.check(H5Aread(attribute.get(), type.get(), buffer), "read it");
  });
}

Shape chunk_shape(const Shape& shape) {
  Shape chunk = shape;
  const hsize_t row = std::max<hsize_t>(1, product(shape) / shape.front());
  chunk.front() = std::clamp<hsize_t>(kChunkValues / row, 1, shape.front());
  return chunk;
}

template <class T>
Handle create_dataset(const Place& place, hid_t group, const Shape& shape, const Attributes& attributes,
                      bool is_dimension) {
  const bool fill = std::is_same_v<T, double> && !is_dimension;
  const Handle type = type_of<T>(place);
  const Handle space = make_space(place, shape);
  const Handle properties = creation_properties<T>(place, shape, fill);
  const Handle access = place.own(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose, "make properties");
  place.check(H5Pset_chunk_cache(access.get(), H5D_CHUNK_CACHE_NSLOTS_DEFAULT, 0, H5D_CHUNK_CACHE_W0_DEFAULT),
              "make properties");
  Handle dataset = place.own(H5Dcreate2(group, place.name.c_str(), type.get(), space.get(), H5P_DEFAULT,
                                        properties.get(), access.get()),
                             H5Dclose, "create it");
  if (fill)
    write_attribute({place.file, "attribute", place.parent + place.name + "/", "_FillValue"}, dataset.get(),
                    kFillValue);
  for (const auto& [name, value] : attributes)
    write_attribute({place.file, "attribute", place.parent + place.name + "/", name}, dataset.get(), value);
  return dataset;
}

template <class T>
Handle write_dataset(const Place& place, hid_t group, const Shape& shape, const std::vector<T>& values,
                     const Attributes& attributes, bool is_dimension) {
  assert(values.size() == product(shape));
  Handle dataset = create_dataset<T>(place, group, shape, attributes, is_dimension);
  const Handle type = type_of<T>(place);
  if (!values.empty())
    with_buffer(values, [&](const void* buffer) {
      place.check(H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer), "write it");
    });
  return dataset;
}

void set_group_properties(const Place& place, hid_t properties) {
  place.check(H5Pset_obj_track_times(properties, false), "make properties");
  place.check(H5Pset_link_creation_order(properties, kTrackOrder), "make properties");
  place.check(H5Pset_attr_creation_order(properties, kTrackOrder), "make properties");
}

Handle open_dataset(const Place& place, hid_t group) {
  if (H5Lexists(group, place.name.c_str(), H5P_DEFAULT) <= 0)
    place.fail("missing");
  return place.own(H5Dopen2(group, place.name.c_str(), H5P_DEFAULT), H5Dclose, "open it");
}

Shape shape_of_dataset(const Place& place, const Handle& dataset) {
  const Handle space = place.own(H5Dget_space(dataset.get()), H5Sclose, "read its shape");
  return shape_of_space(place, space.get());
}

Handle open_dataset(const Place& place, hid_t group, const std::vector<std::size_t>& shape) {
  Handle dataset = open_dataset(place, group);
  const Shape found = shape_of_dataset(place, dataset);
  if (!std::equal(found.begin(), found.end(), shape.begin(), shape.end()))
    place.fail(
        fmt::format("shape ({}) where ({}) is expected", fmt::join(found, ", "), fmt::join(shape, ", ")));
  return dataset;
}

Handle rows_of_space(const Place& place, const Shape& shape, hsize_t first, hsize_t count) {
  Handle space = make_space(place, shape);
  Shape begin(shape.size(), 0), size = shape;
  begin.front() = first;
  size.front() = count;
  place.check(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, begin.data(), nullptr, size.data(), nullptr),
              "select rows of it");
  return space;
}

template <class T>
std::vector<T> read_dataset(const Place& place, const Handle& dataset, const Handle& chosen) {
  const Handle type = place.own(H5Dget_type(dataset.get()), H5Tclose, "read its type");
  require_type<T>(place, type.get());
  const auto count = static_cast<hsize_t>(H5Sget_select_npoints(chosen.get()));
  const Handle here = make_space(place, {count});
  return from_buffer<T>(count, type.get(), here.get(), [&](void* buffer) {
    if (count > 0)
      place.check(H5Dread(dataset.get(), type.get(), here.get(), chosen.get(), H5P_DEFAULT, buffer),
                  "read it");
  });
}

template <class T>
std::vector<T> read_dataset(const Place& place, const Handle& dataset) {
  return read_dataset<T>(place, dataset, place.own(H5Dget_space(dataset.get()), H5Sclose, "read its shape"));
}

#define MPM_INSTANTIATE_DATASET(T)                                                               \
  template Handle create_dataset<T>(const Place&, hid_t, const Shape&, const Attributes&, bool); \
  template Handle write_dataset<T>(const Place&, hid_t, const Shape&, const std::vector<T>&,     \
                                   const Attributes&, bool);                                     \
  template std::vector<T> read_dataset<T>(const Place&, const Handle&, const Handle&);           \
  template std::vector<T> read_dataset<T>(const Place&, const Handle&)

MPM_INSTANTIATE_DATASET(std::int8_t);
MPM_INSTANTIATE_DATASET(std::int32_t);
MPM_INSTANTIATE_DATASET(std::int64_t);
MPM_INSTANTIATE_DATASET(double);
MPM_INSTANTIATE_DATASET(std::string);

template std::vector<std::string> read_attribute<std::string>(const Place&, hid_t);
template std::vector<double> read_attribute<double>(const Place&, hid_t);
template std::vector<std::int32_t> read_attribute<std::int32_t>(const Place&, hid_t);
template std::vector<std::int64_t> read_attribute<std::int64_t>(const Place&, hid_t);
template std::vector<std::uint64_t> read_attribute<std::uint64_t>(const Place&, hid_t);

}  // namespace mpm::hdf5
