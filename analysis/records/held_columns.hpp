#pragma once

#include "scenarios/loop/plant_record.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// Returns the study with which to judge a record whose CVs may be held from one value to the next. If the
/// study knows no analyser of a CV, and the CV has a new value after nearly always the same number of samples
/// (SignalLook::period()), it gets an analyser with this period: only its new values count. If a CV is held
/// for most of the time without such a rhythm (SignalLook::usual_gap() above 1), nobody knows which values
/// count. The warnings about both become the first warnings of the record.
Study with_held_columns(const Study& study, PlantRecord& record);

}  // namespace mpm
