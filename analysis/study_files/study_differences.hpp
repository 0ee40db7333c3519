#pragma once

#include <string>
#include <vector>

#include "scenarios/study/study.hpp"

namespace mpm {

/// A key of a study file with different values in two studies.
struct StudyDifference {
  std::string key;     ///< the whole path: "controller.mv.u1.cost", "simulation.step[0].level"
  std::string before;  ///< as in a study file; empty if that study does not have the key
  std::string now;
};

/// Lists the differences between two studies with every default written out (resolved_study()), in the order
/// of a study file. Keys that only the first study has come last.
///
/// Errors: as resolved_study().
std::vector<StudyDifference> study_differences(const Study& before, const Study& now);

}  // namespace mpm
