#pragma once

#include <string>
#include <vector>

#include "analysis/records/record_panel.hpp"

namespace mpm {

/// Returns one sentence for each column that a historian seems to have kept too early or too late. Every CV,
/// MV and MD is shifted by up to 3 samples against all others. ChannelErrorFit::left is what errors of the
/// model of some percent leave of y - y_sim. A shift is named if it lowers the sum of log left over the CVs
/// by a tenth or more for each CV that it can change, and if no shift of another column does as well. If the
/// same shift improves several CVs, they are said to have one clock. A dead time that differs in one channel
/// is not reported as a column.
std::vector<std::string> column_lags(const RecordFrame& frame, const PlantRecord& record);

}  // namespace mpm
