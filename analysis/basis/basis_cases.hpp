#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "analysis/basis/basis_case.hpp"

namespace mpm {

/// The basis cases of several studies, each made only once, however many callers ask for it from any thread.
class BasisCases {
 public:
  explicit BasisCases(QpSolverFactory factory);
  ~BasisCases();
  BasisCases(const BasisCases&) = delete;
  BasisCases& operator=(const BasisCases&) = delete;

  /// The basis case of this study, which lives as long as the collection. Throws InputError as
  /// run_basis_case().
  const BasisCase& of(const Study& study);

 private:
  struct Entry;

  /// The entry of this study, which is made if no equal study has one.
  Entry& entry_of(const Study& study);

  QpSolverFactory factory_;
  std::mutex mutex_;  ///< of the list, not of its entries
  std::vector<std::unique_ptr<Entry>> entries_;
};

}  // namespace mpm
