#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "analysis/experiment/record_range.hpp"
#include "results/archive/hdf5_file.hpp"
#include "results/archive/record_tables.hpp"

namespace mpm {

/// Reads all or some of the records of an archive: the reverse of write_records().
///
/// In memory it keeps the index of each experiment and, for each table that covers only some experiments,
/// their places. Errors: ArchiveError, which names the file and what is wrong or missing in it; an error in a
/// single record is thrown when that record is read.
class ArchiveRecordReader {
 public:
  /// `root` is the root group of an archive of `study`, which has these tables. `file` is for messages.
  ArchiveRecordReader(const Hdf5Group& root, const Study& study, const AssessmentForms& forms,
                      std::vector<RecordTable> tables, std::string file);

  std::size_t size() const { return indices_.size(); }
  /// Returns how many records are best read at a time.
  std::size_t block() const { return block_; }

  /// Returns `count` records, starting with number `first`, in the order of their index.
  std::vector<ExperimentRecord> read(std::size_t first, std::size_t count) const;

 private:
  void read_table(std::size_t table, std::size_t first, std::vector<ExperimentRecord>& records) const;

  Study study_;
  std::string file_;
  std::vector<std::int64_t> indices_;
  std::vector<RecordTable> tables_;
  std::vector<Hdf5Group> groups_;                 ///< group of each table
  std::vector<std::vector<std::size_t>> places_;  ///< places in each table that only some experiments are in
  std::vector<double> milliseconds_;              ///< processor time of each method; not stored in records
  std::size_t block_ = 1;
};

/// Returns the records as a range that holds one block at a time in memory.
RecordRange streamed(std::shared_ptr<const ArchiveRecordReader> reader);

}  // namespace mpm
