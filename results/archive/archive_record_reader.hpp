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

/// Reads the records of an archive, all of them or some: the reverse of write_records().
///
/// In memory are the index of each experiment and, of tables that some experiments stand in, their places.
/// Errors: ArchiveError, which names the file and what is wrong or missing in it; that of a single record
/// comes when it is read.
class ArchiveRecordReader {
 public:
  /// `root` is that of the archive of this study, which has these tables; `file` is for messages.
  ArchiveRecordReader(const Hdf5Group& root, const Study& study, const AssessmentForms& forms,
                      std::vector<RecordTable> tables, std::string file);

  std::size_t size() const { return indices_.size(); }
  /// How many are best read at a time.
  std::size_t block() const { return block_; }

  /// `count` records from the place `first` on, in the order of their index.
  std::vector<ExperimentRecord> read(std::size_t first, std::size_t count) const;

 private:
  void read_table(std::size_t table, std::size_t first, std::vector<ExperimentRecord>& records) const;

  Study study_;
  std::string file_;
  std::vector<std::int64_t> indices_;
  std::vector<RecordTable> tables_;
  std::vector<Hdf5Group> groups_;                 ///< of the tables
  std::vector<std::vector<std::size_t>> places_;  ///< of the experiments in a table that not all stand in
  std::vector<double> milliseconds_;              ///< of the methods, which no record has in the file
  std::size_t block_ = 1;
};

/// The records, one block at a time.
RecordRange streamed(std::shared_ptr<const ArchiveRecordReader> reader);

}  // namespace mpm
