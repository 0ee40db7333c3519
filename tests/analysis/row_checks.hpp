#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "base/row.hpp"

namespace mpm::testing {

/// Every number of `Owner` has one row with a name of its own, and a row sets and reads no other number.
template <class Owner>
void check_rows(const std::vector<Row<Owner>>& rows, std::size_t count) {
  std::set<std::string> names;
  const double two = 2.0;
  for (const Row<Owner>& row : rows) {
    names.insert(row.text.name);
    CHECK_FALSE(row.text.unit.empty());
    CHECK_FALSE(row.text.meaning.empty());
    CHECK((row.text.words.empty() || row.text.words.size() >= 3));
    Owner one;
    put_numbers(row, one, &two);
    for (const Row<Owner>& other : rows) {
      INFO(row.text.name << " " << other.text.name);
      CHECK((numbers_of(other, one).front() == 2.0) == (other.text.name == row.text.name));
    }
  }
  CHECK(names.size() == rows.size());
  CHECK(rows.size() == count);
}

}  // namespace mpm::testing
