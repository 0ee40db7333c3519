#pragma once

#include "scenarios/study/study.hpp"

namespace mpm {

/// Allows the programs and the FMU that a study names (base/system/program_trust). Call it only for studies
/// in the user's own files: a study in an archive or in a part of a campaign may come from somebody else.
void trust_programs_of(const Study& study);

}  // namespace mpm
