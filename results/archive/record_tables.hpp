#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "analysis/experiment/experiment.hpp"
#include "analysis/findings/study_findings.hpp"
#include "results/archive/variable_text.hpp"

// The one description of an experiment's record: each number of it with its name, its meaning, its shape and
// where it is in memory. The archive, the bytes of a shard and the comparison of `replay` iterate over it.

namespace mpm {

/// How the values of a variable are taken out of a record and put back, in the order of a file: the last
/// dimension fastest. Without `set` they follow from others and are not put back.
template <class T>
struct RecordAccess {
  std::function<void(const ExperimentRecord&, T* values)> get;
  std::function<void(ExperimentRecord&, const T* values)> set;
};

/// Where a variable takes part.
enum class RecordUse {
  everywhere,
  archive_only,  ///< follows from the others
  bytes_only,    ///< differs from run to run, so that no archive has it and no comparison looks at it
};

struct RecordVariable {
  VariableText text;
  std::vector<std::string> dimensions;  ///< after that of the records
  std::vector<std::size_t> shape;       ///< their lengths
  std::variant<RecordAccess<std::int8_t>, RecordAccess<std::int32_t>, RecordAccess<std::int64_t>,
               RecordAccess<double>, RecordAccess<std::string>>
      access;
  RecordUse use = RecordUse::everywhere;
  bool may_lack =
      false;  ///< archives of earlier minor versions have it not; records then keep what they are made with

  std::size_t size() const;
};

/// Variables of a group of the archive, along a dimension of all or some of the experiments.
struct RecordTable {
  std::string group;       ///< "methods/botelho"; empty: the root group
  std::string dimension;   ///< "experiment", "stored", "perturbed"
  std::string title;       ///< of the group; empty for the root group
  bool from_draw = false;  ///< they follow from study and index, by which bytes draw the experiment anew
  /// Which experiments stand in it, and how room is made in a record; empty: all of them.
  std::function<bool(const ExperimentRecord&)> has = {};
  std::function<void(ExperimentRecord&)> make = {};
  std::vector<RecordVariable> variables = {};
};

/// All tables of the records of a study, in an order in which they can be put back.
std::vector<RecordTable> record_tables(const Study& study, const AssessmentForms& forms);

/// The numbers of one method, which stands at place `method` of the assessments.
RecordTable method_table(const AssessmentForm& form, std::size_t method);

}  // namespace mpm
