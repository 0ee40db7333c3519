#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "base/non_finite.hpp"
#include "base/number_text.hpp"
#include "base/row_major.hpp"

// A row describes a number: its text, its shape, and how it is taken out of its owner and put back. Archives,
// the bytes of shards, comparisons, CSV and JSON iterate over tables of rows.

namespace mpm {

/// How the values of a row are taken out of an owner and put back, in the order of a file: the last dimension
/// varies fastest. If there is no `set`, the values follow from others and are not put back.
template <class Owner, class T>
struct RowAccess {
  std::function<void(const Owner&, T* values)> get;
  std::function<void(Owner&, const T* values)> set = {};
};

/// Where a row is used.
enum class RowUse {
  everywhere,
  archive_only,  ///< the value follows from other rows
  bytes_only,    ///< the value differs from run to run, so that archives omit it and comparisons ignore it
};

/// One number of an `Owner`, or an array of numbers, with the type that they have in a file.
template <class Owner>
struct Row {
  NumberText text;
  std::vector<std::string> dimensions;  ///< names, after the dimension of the owners
  std::vector<std::size_t> shape;       ///< lengths of the dimensions
  std::variant<RowAccess<Owner, std::int8_t>, RowAccess<Owner, std::int32_t>, RowAccess<Owner, std::int64_t>,
               RowAccess<Owner, double>, RowAccess<Owner, std::string>>
      access;
  RowUse use = RowUse::everywhere;
  /// First minor version of archives that has this row; 0: all have it. Owners that are read from an archive
  /// of an earlier version keep their default.
  int since = 0;
  std::string coordinates = {};  ///< a variable with further coordinates, such as `time`; empty: none

  std::size_t size() const {
    return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
  }
  Row only(RowUse where) const { return changed(&Row::use, where); }
  Row from_version(int minor) const { return changed(&Row::since, minor); }
  Row along(const char* variable) const { return changed(&Row::coordinates, variable); }

 private:
  template <class Member, class Value>
  Row changed(Member Row::*member, Value value) const {
    Row row = *this;
    row.*member = value;
    return row;
  }
};

/// Calls take(values) with the values of one owner as a vector of their type.
template <class Owner, class Take>
void take_values(const Row<Owner>& row, const Owner& owner, Take take) {
  std::visit(
      [&]<class T>(const RowAccess<Owner, T>& access) {
        std::vector<T> values(row.size());
        access.get(owner, values.data());
        take(values);
      },
      row.access);
}

/// Puts back the values that fill(values) writes into a vector of their type.
template <class Owner, class Fill>
void put_values(const Row<Owner>& row, Owner& owner, Fill fill) {
  std::visit(
      [&]<class T>(const RowAccess<Owner, T>& access) {
        std::vector<T> values(row.size());
        fill(values);
        access.set(owner, values.data());
      },
      row.access);
}

/// Returns the values of one owner as numbers; a text becomes NaN.
template <class Owner>
std::vector<double> numbers_of(const Row<Owner>& row, const Owner& owner) {
  std::vector<double> numbers(row.size(), kNaN);
  take_values(row, owner, [&]<class T>(const std::vector<T>& values) {
    if constexpr (!std::is_same_v<T, std::string>)
      std::transform(values.begin(), values.end(), numbers.begin(),
                     [](T value) { return static_cast<double>(value); });
  });
  return numbers;
}

/// Puts numbers back. In a row of whole numbers, -1 replaces NaN.
template <class Owner>
void put_numbers(const Row<Owner>& row, Owner& owner, const double* numbers) {
  put_values(row, owner, [&]<class T>(std::vector<T>& values) {
    if constexpr (!std::is_same_v<T, std::string>)
      std::transform(numbers, numbers + values.size(), values.begin(), [](double number) {
        return std::is_integral_v<T> && std::isnan(number) ? T{-1} : static_cast<T>(number);
      });
  });
}

// --- How rows are made. A lens is a member, or a function that gives a reference to a part of its owner. ---

/// Looks through several lenses, one after the other: path(&Diagnosis::indicator, &MpmIndicator::i_mpm).
template <class Lens>
Lens path(Lens lens) {
  return lens;
}
template <class First, class... Further>
auto path(First first, Further... further) {
  return [=](auto& owner) -> auto& {
    return std::invoke(path(further...), std::invoke(first, owner));
  };
}

/// One value of each owner; without `set` it is not put back.
template <class T, class Owner>
Row<Owner> value_row(NumberText text, std::function<T(const Owner&)> get,
                     std::function<void(Owner&, T)> set = {}) {
  RowAccess<Owner, T> access{[get = std::move(get)](const Owner& owner, T* value) { *value = get(owner); }};
  if (set)
    access.set = [set = std::move(set)](Owner& owner, const T* value) { set(owner, *value); };
  return {std::move(text), {}, {}, std::move(access)};
}

/// One member, stored as it is in memory except for its type. If a value that is put back does not fit a
/// whole-number member, or has no word although the row of an enumeration has words, the member stays
/// unchanged.
template <class T, class Owner, class Lens>
Row<Owner> member_row(NumberText text, Lens lens) {
  return value_row<T, Owner>(
      text, [lens](const Owner& owner) { return static_cast<T>(std::invoke(lens, owner)); },
      [lens, words = text.words](Owner& owner, T value) {
        auto& member = std::invoke(lens, owner);
        using Member = std::remove_cvref_t<decltype(member)>;
        if constexpr (std::is_floating_point_v<T> && std::is_integral_v<Member>)
          if (!(2.0 * std::abs(value) <= static_cast<T>(std::numeric_limits<Member>::max())))  // NaN as well
            return;
        if constexpr (std::is_enum_v<Member>)
          if (!words.empty() && word_for(words, value) == nullptr)
            return;
        member = static_cast<Member>(std::move(value));
      });
}
template <class T, class Owner, class Member>
Row<Owner> member_row(NumberText text, Member Owner::*member) {
  return member_row<T, Owner, Member Owner::*>(std::move(text), member);
}

/// One vector of each owner; the elements that it lacks are NaN in the file.
template <class Owner, class Lens>
Row<Owner> vector_row(NumberText text, std::string dimension, Eigen::Index size, Lens lens) {
  RowAccess<Owner, double> access{
      [lens, size](const Owner& owner, double* values) {
        const Eigen::VectorXd& from = std::invoke(lens, owner);
        std::fill_n(std::copy(from.begin(), from.end(), values), size - from.size(), kNaN);
      },
      [lens, size](Owner& owner, const double* values) {
        std::invoke(lens, owner) = Eigen::Map<const Eigen::VectorXd>(values, size);
      }};
  return {std::move(text), {std::move(dimension)}, {static_cast<std::size_t>(size)}, std::move(access)};
}

/// One matrix of each owner, row by row; if it is empty, all elements are NaN in the file.
template <class Owner, class Lens>
Row<Owner> matrix_row(NumberText text, std::vector<std::string> dimensions, Eigen::Index rows,
                      Eigen::Index columns, Lens lens) {
  RowAccess<Owner, double> access{
      [lens, rows, columns](const Owner& owner, double* values) {
        Eigen::Map<RowMajorMatrix> to(values, rows, columns);
        if (const Eigen::MatrixXd& from = std::invoke(lens, owner); from.size() == 0)
          to.setConstant(kNaN);
        else
          to = from;
      },
      [lens, rows, columns](Owner& owner, const double* values) {
        std::invoke(lens, owner) = Eigen::Map<const RowMajorMatrix>(values, rows, columns);
      }};
  return {std::move(text),
          std::move(dimensions),
          {static_cast<std::size_t>(rows), static_cast<std::size_t>(columns)},
          std::move(access)};
}

/// Turns the row of a part into a row of the whole.
template <class Whole, class Part, class Lens>
Row<Whole> of_part(const Row<Part>& row, Lens lens) {
  return std::visit(
      [&]<class T>(const RowAccess<Part, T>& part) {
        RowAccess<Whole, T> access{
            [get = part.get, lens](const Whole& whole, T* values) { get(std::invoke(lens, whole), values); }};
        if (part.set)
          access.set = [set = part.set, lens](Whole& whole, const T* values) {
            set(std::invoke(lens, whole), values);
          };
        return Row<Whole>{row.text, row.dimensions, row.shape,      std::move(access),
                          row.use,  row.since,      row.coordinates};
      },
      row.access);
}
template <class Whole, class Part, class Lens>
std::vector<Row<Whole>> of_part(const std::vector<Row<Part>>& rows, Lens lens) {
  std::vector<Row<Whole>> list;
  for (const Row<Part>& row : rows)
    list.push_back(of_part<Whole>(row, lens));
  return list;
}

/// Turns the row of a part into a row of the whole, which holds `count` equal parts in a vector. The parts
/// become the dimension `dimension`.
template <class Whole, class Part, class Lens>
Row<Whole> of_each(const Row<Part>& row, std::string dimension, std::size_t count, Lens lens) {
  return std::visit(
      [&]<class T>(const RowAccess<Part, T>& part) {
        RowAccess<Whole, T> access{
            [get = part.get, lens, count, size = row.size()](const Whole& whole, T* values) {
              for (std::size_t i = 0; i < count; ++i)
                get(std::invoke(lens, whole)[i], values + i * size);
            },
            [set = part.set, lens, count, size = row.size()](Whole& whole, const T* values) {
              std::invoke(lens, whole).resize(count);
              for (std::size_t i = 0; i < count; ++i)
                set(std::invoke(lens, whole)[i], values + i * size);
            }};
        Row<Whole> made{row.text,  {std::move(dimension)}, {count}, std::move(access), row.use,
                        row.since, row.coordinates};
        made.dimensions.insert(made.dimensions.end(), row.dimensions.begin(), row.dimensions.end());
        made.shape.insert(made.shape.end(), row.shape.begin(), row.shape.end());
        return made;
      },
      row.access);
}

}  // namespace mpm
