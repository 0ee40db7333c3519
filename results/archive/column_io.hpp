#pragma once

#include <cassert>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "results/archive/columns.hpp"
#include "results/archive/hdf5_file.hpp"
#include "results/files/archive_error.hpp"

namespace mpm {

/// Writes one value an owner for every column. `dimensions` is the dimension along the owners, or none when
/// there is one owner.
template <class Owner>
void write_columns(Hdf5Group& group, const std::vector<std::string>& dimensions,
                   const std::vector<Column<Owner>>& columns, const std::vector<const Owner*>& owners) {
  for (const Column<Owner>& column : columns) {
    std::visit(
        [&]<class T>(const Access<Owner, T>& access) {
          std::vector<T> values;
          values.reserve(owners.size());
          for (const Owner* owner : owners)
            values.push_back(access.get(*owner));
          group.write(column.text.name, dimensions, values, attributes<T>(column.text));
        },
        column.access);
  }
}

/// Throws ArchiveError when a flag has a value without a meaning.
template <class T>
void require_flags(const VariableText& text, const std::vector<T>& values, const std::string& file) {
  if (const T* const value = value_without_meaning(text, values))
    throw ArchiveError(fmt::format("{}: variable '{}': found {}; allowed: {} to {}", file, text.name, *value,
                                   text.flags.values.front(), text.flags.values.back()));
}

/// The reverse of write_columns(); `file` is for messages.
template <class Owner>
void read_columns(const Hdf5Group& group, const std::vector<std::size_t>& shape,
                  const std::vector<Column<Owner>>& columns, const std::vector<Owner*>& owners,
                  const std::string& file) {
  for (const Column<Owner>& column : columns) {
    std::visit(
        [&]<class T>(const Access<Owner, T>& access) {
          const std::vector<T> values = group.read<T>(column.text.name, shape);
          assert(values.size() == owners.size());
          require_flags(column.text, values, file);
          for (std::size_t i = 0; i < owners.size(); ++i)
            access.set(*owners[i], values[i]);
        },
        column.access);
  }
}

}  // namespace mpm
