#pragma once

#include "scenarios/study/study.hpp"

namespace mpm {

/// Allows the programs and the FMU that a study names (base/system/program_trust): for studies of the
/// user's own files. One that an archive or a part of a campaign holds is somebody else's.
void trust_programs_of(const Study& study);

}  // namespace mpm
