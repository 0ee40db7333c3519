#include "analysis/basis/basis_cases.hpp"

#include <algorithm>
#include <utility>

#include "analysis/basis/basis_runs.hpp"

namespace mpm {

struct BasisCases::Entry {
  Study study;
  std::once_flag made;
  BasisCase basis;
};

BasisCases::BasisCases(QpSolverFactory factory) : factory_(std::move(factory)) {}

BasisCases::~BasisCases() = default;

BasisCases::Entry& BasisCases::entry_of(const Study& study) {
  const std::lock_guard lock(mutex_);
  const auto known = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const auto& entry) { return entry->study == study; });
  if (known != entries_.end())
    return **known;
  entries_.push_back(std::make_unique<Entry>());
  entries_.back()->study = study;
  return *entries_.back();
}

const BasisCase& BasisCases::of(const Study& study) {
  Entry& entry = entry_of(study);
  std::call_once(entry.made, [&] { entry.basis = run_basis_case(entry.study, factory_); });
  return entry.basis;
}

}  // namespace mpm
