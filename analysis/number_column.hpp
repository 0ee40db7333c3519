#pragma once

#include <functional>
#include <string>

namespace mpm {

/// One number of an `Owner`, for those who list all of them without naming each (a summary, a table).
template <class Owner>
struct NumberColumn {
  std::string name;     ///< unique among the columns of an Owner, in the form of a variable name
  std::string unit;     ///< "1", "degrees", "samples"
  std::string meaning;  ///< what it is, in one line, with its equation
  std::function<double(const Owner&)> value;
};

}  // namespace mpm
