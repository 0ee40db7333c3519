#pragma once

#include <cstddef>
#include <vector>

#include "results/archive/hdf5_attributes.hpp"
#include "results/archive/hdf5_values.hpp"

// Attributes and variables of a group. T is a type of Hdf5Group, or of an attribute.

namespace mpm::hdf5 {

/// Of a group, or of a file for its root group. Without times, so that the same content is the same bytes.
void set_group_properties(const Place& place, hid_t properties);

void write_attribute(const Place& place, hid_t object, const AttributeValue& value);
template <class T>
std::vector<T> read_attribute(const Place& place, hid_t object);

/// Whole rows of the first dimension, as many as give a chunk of about kChunkValues values.
Shape chunk_shape(const Shape& shape);

/// A variable without values. It keeps no chunk in memory: whole ones are written.
template <class T>
Handle create_dataset(const Place& place, hid_t group, const Shape& shape, const Attributes& attributes,
                      bool is_dimension);
template <class T>
Handle write_dataset(const Place& place, hid_t group, const Shape& shape, const std::vector<T>& values,
                     const Attributes& attributes, bool is_dimension);

Handle open_dataset(const Place& place, hid_t group);
/// A variable that has this shape.
Handle open_dataset(const Place& place, hid_t group, const std::vector<std::size_t>& shape);
Shape shape_of_dataset(const Place& place, const Handle& dataset);

/// The space of a variable of this shape with `count` rows from `first` on chosen.
Handle rows_of_space(const Place& place, const Shape& shape, hsize_t first, hsize_t count);

/// The selected part of the space of a variable, or all of it.
template <class T>
std::vector<T> read_dataset(const Place& place, const Handle& dataset, const Handle& chosen);
template <class T>
std::vector<T> read_dataset(const Place& place, const Handle& dataset);

}  // namespace mpm::hdf5
