#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <vector>

#include <Eigen/Core>

#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/method_messages.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// The loops of a blind export while they are made, which is in another order than that in which they are
/// written: on the disk, in a file that goes with this object.
///
/// Errors: ArchiveError, which names the folder.
class LoopStore {
 public:
  /// Of `count` loops of `study`, which must outlive it.
  LoopStore(std::filesystem::path folder, const Study& study, std::size_t count);

  std::size_t size() const { return count_; }

  /// Keeps loop `number`; one without samples did not run to its end, and is missing throughout.
  void put(std::size_t number, const AssessedLoop& loop);

  /// A signal of a loop that was put.
  Eigen::MatrixXd signal(std::size_t number, const LoopSignal& signal);
  /// All of them.
  AssessedLoop loop(std::size_t number);

 private:
  void seek(std::size_t number, std::size_t value);
  void require(const char* action) const;

  std::filesystem::path folder_;
  const Study& study_;
  std::size_t count_;
  std::size_t values_ = 0;  ///< of a loop
  std::fstream file_;
};

/// The names of the rows of a signal of the loops of a study.
std::vector<std::string> row_names(const Study& study, const LoopSignal& signal);

}  // namespace mpm
