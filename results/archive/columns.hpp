#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>

#include "analysis/experiment/experiment.hpp"
#include "results/archive/hdf5_file.hpp"
#include "results/archive/variable_text.hpp"
#include "results/files/archive_error.hpp"
#include "scenarios/loop/audit.hpp"

namespace mpm {

/// The values of enumerators and their words; each has a to_string().
template <class Enum, std::size_t n>
Flags enum_flags(const std::array<Enum, n>& values) {
  Flags flags;
  for (const Enum value : values) {
    flags.values.push_back(static_cast<int>(value));
    flags.meanings.push_back(flag_word(std::string(to_string(value))));
  }
  return flags;
}

/// How one number of an `Owner` is taken out and put back.
template <class Owner, class T>
struct Access {
  std::function<T(const Owner&)> get;
  std::function<void(Owner&, T)> set;
};

/// One number of an `Owner` as a variable of the archive: the one place that says what it is called, what it
/// means and where it is in memory.
template <class Owner>
struct Column {
  VariableText text;
  std::variant<Access<Owner, std::int8_t>, Access<Owner, std::int32_t>, Access<Owner, std::int64_t>,
               Access<Owner, double>, Access<Owner, std::string>>
      access;
};

/// A record of a closed loop, one row a variable: the dimension of its rows and where it is in memory.
struct SignalColumn {
  VariableText text;
  std::string rows;  ///< "cv", "mv" or "md"
  Eigen::MatrixXd Trajectory::*member;
};

/// How hard the optimisation problems were, and how well they were solved.
std::vector<Column<SolverStatistics>> solver_columns();
/// What the audit of a step found.
std::vector<Column<AuditedStep>> audit_columns();
/// How a closed loop ended.
std::vector<Column<Trajectory>> loop_columns();
/// Everything that was recorded in a closed loop.
std::vector<SignalColumn> signal_columns(const Study& study);
/// How many rows the signal has in this study.
Eigen::Index row_count(const SignalColumn& signal, const Study& study);
/// y_sim, which is no member of a Trajectory.
VariableText y_sim_text(const Study& study);

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
