#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "results/archive/record_tables.hpp"

namespace mpm {

/// The records of one study as bytes, for the way between processes of this program and into shards, and what
/// differs between two of them. What was drawn is not among the bytes: it follows from study and index.
class RecordBytes {
 public:
  /// `study` must outlive it.
  RecordBytes(const Study& study, std::vector<RecordTable> tables);
  RecordBytes(const Study& study, const AssessmentForms& forms)
      : RecordBytes(study, record_tables(study, forms)) {}

  /// Every number keeps its bits.
  std::string to_bytes(const ExperimentRecord& record) const;

  /// The record again. Throws std::runtime_error when the bytes are too short or too long or hold what no
  /// row can be, InputError for an index that is no experiment of the study.
  ExperimentRecord from_bytes(std::string_view bytes) const;

  /// The names of the rows whose values are not the same, bit for bit.
  std::vector<std::string> differences(const ExperimentRecord& one, const ExperimentRecord& other) const;

 private:
  const Study& study_;
  std::vector<RecordTable> tables_;
};

}  // namespace mpm
