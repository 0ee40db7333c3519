#pragma once

#include <string>
#include <vector>

#include "analysis/records/record_panel.hpp"

namespace mpm {

/// The columns that a historian seems to have kept too early or too late, a sentence each. Every CV, MV and
/// MD is shifted by up to 3 samples against all others: a shift is named if it makes the sum over the CVs of
/// log ChannelErrorFit::left, what errors of the model of some percent leave of y - y_sim, smaller by a tenth
/// and more for each CV that it can change, and none of another column does as well. Of several CVs that the
/// same shift makes better they are said to have one clock. A dead time that differs in one channel is not a
/// column.
std::vector<std::string> column_lags(const RecordFrame& frame, const PlantRecord& record);

}  // namespace mpm
