#pragma once

#include <optional>
#include <string>

#include "analysis/indicators/diagnosis.hpp"
#include "analysis/sensitivity/nominal_sensitivity.hpp"
#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/loop/world.hpp"

namespace mpm {

/// The run without mismatch and disturbance, with which every experiment is compared, and whether the chain
/// itself calls it healthy.
///
/// With too little excitation the variances of the active CVs are mostly noise, which S0 filters out of y0,
/// and Ivar of a perfect model is far from 1: every experiment would then count as impactful and the location
/// of the CV would be chance. A study must therefore pass this check first. A study without excitation needs
/// another check (SelfCheck): its y0 has no variance of its own, so the check is whether two healthy loops
/// have the same variance, the reference of Ivar_basis (6.22).
struct BasisCase {
  int world = kExactWorld;  ///< the world whose benchmark is `trajectory`
  OperatingPoint point;
  NominalSensitivity sensitivity;
  /// The direct step responses beside an identified `sensitivity`; none unless the study has it identified.
  std::optional<NominalSensitivity> sensitivity_direct;
  /// T0 with the MVs of `study.s0_perturbation.fixed_mvs` held; none if the study names no such MVs.
  std::optional<NominalSensitivity> sensitivity_fixed;
  Trajectory trajectory;
  NominalOutputs nominal;
  Diagnosis diagnosis;
  bool healthy = false;
  std::string explanation;  ///< one sentence for people, also when healthy
};

}  // namespace mpm
