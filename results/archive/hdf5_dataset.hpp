#pragma once

#include <cstddef>
#include <vector>

#include "results/archive/hdf5_attributes.hpp"
#include "results/archive/hdf5_values.hpp"

// Attributes and variables of a group. T is one of the types of Hdf5Group, or of those of an attribute.

namespace mpm::hdf5 {

/// Sets the properties of a group, or of a file for its root group. No times are stored, so that the same
/// content gives the same bytes.
void set_group_properties(const Place& place, hid_t properties);

void write_attribute(const Place& place, hid_t object, const AttributeValue& value);
template <class T>
std::vector<T> read_attribute(const Place& place, hid_t object);

/// Returns the shape of a chunk: as many whole rows of the first dimension as hold about kChunkValues values.
Shape chunk_shape(const Shape& shape);

/// Creates a variable without values. It caches no chunk in memory, because only whole chunks are written.
template <class T>
Handle create_dataset(const Place& place, hid_t group, const Shape& shape, const Attributes& attributes,
                      bool is_dimension);
template <class T>
Handle write_dataset(const Place& place, hid_t group, const Shape& shape, const std::vector<T>& values,
                     const Attributes& attributes, bool is_dimension);

Handle open_dataset(const Place& place, hid_t group);
/// Opens a variable and checks that it has this shape.
Handle open_dataset(const Place& place, hid_t group, const std::vector<std::size_t>& shape);
Shape shape_of_dataset(const Place& place, const Handle& dataset);

/// Returns the space of a variable of this shape, with `count` rows selected from row `first` on.
Handle rows_of_space(const Place& place, const Shape& shape, hsize_t first, hsize_t count);

/// Reads the part of a variable that `chosen` selects, or all of it.
template <class T>
std::vector<T> read_dataset(const Place& place, const Handle& dataset, const Handle& chosen);
template <class T>
std::vector<T> read_dataset(const Place& place, const Handle& dataset);

}  // namespace mpm::hdf5
