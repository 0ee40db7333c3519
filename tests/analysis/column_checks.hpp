#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/indicators/number_column.hpp"

namespace mpm::testing {

/// Every number of `Owner` has one column with a name of its own, and a column sets and reads no other
/// number.
template <class Owner>
void check_columns(const std::vector<NumberColumn<Owner>>& columns, std::size_t count) {
  std::set<std::string> names;
  for (const auto& column : columns) {
    names.insert(column.name);
    CHECK_FALSE(column.unit.empty());
    CHECK_FALSE(column.meaning.empty());
    CHECK((column.words.empty() || column.words.size() >= 3));
    Owner one;
    column.set(one, 2.0);
    for (const auto& other : columns) {
      INFO(column.name << " " << other.name);
      CHECK((other.value(one) == 2.0) == (other.name == column.name));
    }
  }
  CHECK(names.size() == columns.size());
  CHECK(columns.size() == count);
}

}  // namespace mpm::testing
