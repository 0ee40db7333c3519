#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "results/archive/record_tables.hpp"

namespace mpm {

/// Converts records of one study to bytes, which pass between processes of this program and into shards, and
/// compares two records. What was drawn is not among the bytes: it follows from study and index.
class RecordBytes {
 public:
  /// `study` must outlive it.
  RecordBytes(const Study& study, std::vector<RecordTable> tables);
  RecordBytes(const Study& study, const AssessmentForms& forms)
      : RecordBytes(study, record_tables(study, forms)) {}

  /// Every number keeps its bits.
  std::string to_bytes(const ExperimentRecord& record) const;

  /// Reads the record back. Throws std::runtime_error if the bytes are too short or too long or hold a value
  /// that a row cannot have, and InputError if the index is no experiment of the study.
  ExperimentRecord from_bytes(std::string_view bytes) const;

  /// Returns the names of the rows whose values differ in any bit.
  std::vector<std::string> differences(const ExperimentRecord& one, const ExperimentRecord& other) const;

 private:
  const Study& study_;
  std::vector<RecordTable> tables_;
};

}  // namespace mpm
