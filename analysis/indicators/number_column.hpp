#pragma once

#include <functional>
#include <string>
#include <vector>

namespace mpm {

/// One number of an `Owner`, for those who list all of them without naming each (a summary, a table), or keep
/// them and put them back (an archive, a message between processes).
template <class Owner>
struct NumberColumn {
  std::string name;     ///< unique among the columns of an Owner, in the form of a variable name
  std::string unit;     ///< "1", "degrees", "samples"
  std::string meaning;  ///< what it is, in one line, with its equation
  std::function<double(const Owner&)> value;
  /// Puts a number back; of a verdict, one of 0 ... words.size() - 1.
  std::function<void(Owner&, double)> set;
  /// What the numbers 0, 1, 2, ... of a verdict stand for; none for a quantity.
  std::vector<std::string> words = {};
};

}  // namespace mpm
