#pragma once

#include <cassert>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/row.hpp"
#include "results/archive/hdf5_file.hpp"
#include "results/archive/variable_text.hpp"
#include "results/files/archive_error.hpp"

// Writes rows of owners in memory as variables of a group, and reads them back.

namespace mpm {

template <class T, class Owner>
Attributes attributes(const Row<Owner>& row) {
  return attributes<T>(row.text, row.coordinates);
}

/// Writes the rows of all these owners. `along` is the dimension of the owners; it is empty for a single
/// owner.
template <class Owner>
void store_rows(Hdf5Group& group, const std::vector<std::string>& along, const std::vector<Row<Owner>>& rows,
                const std::vector<Owner>& owners) {
  for (const Row<Owner>& row : rows)
    std::visit(
        [&]<class T>(const RowAccess<Owner, T>& access) {
          std::vector<T> values(owners.size() * row.size());
          T* place = values.data();
          for (const Owner& owner : owners) {
            access.get(owner, place);
            place += row.size();
          }
          std::vector<std::string> dimensions = along;
          dimensions.insert(dimensions.end(), row.dimensions.begin(), row.dimensions.end());
          group.write(row.text.name, dimensions, values, attributes<T>(row));
        },
        row.access);
}
template <class Owner>
void store_rows(Hdf5Group& group, const std::vector<Row<Owner>>& rows, const Owner& owner) {
  store_rows(group, {}, rows, std::vector<Owner>{owner});
}

/// Throws ArchiveError if a value that must have a word has none.
template <class T>
void require_words(const NumberText& text, const std::vector<T>& values, const std::string& file) {
  if (const T* const value = value_without_word(text, values))
    throw ArchiveError(fmt::format("{}: variable '{}': found {}; allowed: {} to {}", file, text.name, *value,
                                   text.words.front().value, text.words.back().value));
}

/// The reverse of store_rows(), for the rows that can be read back; `file` is for messages.
template <class Owner>
void load_rows(const Hdf5Group& group, const std::vector<std::size_t>& along,
               const std::vector<Row<Owner>>& rows, std::vector<std::reference_wrapper<Owner>> owners,
               const std::string& file) {
  for (const Row<Owner>& row : rows)
    std::visit(
        [&]<class T>(const RowAccess<Owner, T>& access) {
          if (!access.set)
            return;
          std::vector<std::size_t> shape = along;
          shape.insert(shape.end(), row.shape.begin(), row.shape.end());
          const std::vector<T> values = group.read<T>(row.text.name, shape);
          assert(values.size() == owners.size() * row.size());
          require_words(row.text, values, file);
          const T* place = values.data();
          for (Owner& owner : owners) {
            access.set(owner, place);
            place += row.size();
          }
        },
        row.access);
}
template <class Owner>
void load_rows(const Hdf5Group& group, const std::vector<Row<Owner>>& rows, Owner& owner,
               const std::string& file) {
  load_rows(group, {}, rows, {owner}, file);
}
template <class Owner>
void load_rows(const Hdf5Group& group, const std::vector<Row<Owner>>& rows, std::vector<Owner>& owners,
               const std::string& file) {
  load_rows(group, {owners.size()}, rows, {owners.begin(), owners.end()}, file);
}

}  // namespace mpm
