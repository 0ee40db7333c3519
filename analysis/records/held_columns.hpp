#pragma once

#include "scenarios/loop/plant_record.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// The study by which a record is to be judged whose CVs may be held from one value to the next. A CV of
/// which the study knows no analyser, with a new value after nearly always the same number of samples
/// (SignalLook::period()), is one that an analyser measures with this period: only its new values count. Of
/// one that is held for most of the time, but in no such rhythm (SignalLook::usual_gap() above 1), nobody
/// knows which values count. The record's warnings begin with both.
Study with_held_columns(const Study& study, PlantRecord& record);

}  // namespace mpm
