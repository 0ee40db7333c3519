#pragma once

#include <string>
#include <vector>

#include "scenarios/study/study.hpp"

namespace mpm {

/// A key of a study file that two studies have other values of.
struct StudyDifference {
  std::string key;     ///< the whole path: "controller.mv.u1.cost", "simulation.step[0].level"
  std::string before;  ///< as a study file has it; empty: the key has no place in that study
  std::string now;
};

/// What differs between two studies, with every default written out (resolved_study()), in the order of a
/// study file; keys of the first study that the second has not come last.
///
/// Errors: as resolved_study().
std::vector<StudyDifference> study_differences(const Study& before, const Study& now);

}  // namespace mpm
