#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "results/records/record_columns.hpp"

namespace mpm {

/// Returns the column whose heading says that it is the quality of `column`: "xD.Status", "xD_Quality" or
/// "Status xD", for "xD" and also for "xD.PV" or "xD.Value". If there is none, returns the one column of
/// qualities (are_qualities()) named "quality" or "status". Returns none if neither exists, or if there are
/// several.
std::optional<std::size_t> quality_column_of(const RecordColumns& file, std::size_t column);

/// Tells whether a column holds qualities, whatever its heading says: at least one cell is good
/// (is_good_opc()), and either all cells are words, or all are codes of OPC DA or UA. An empty cell says
/// nothing.
bool are_qualities(const RecordColumns& file, std::size_t column);

/// Returns the column that a historian stores beside another one of the same tag, as "AI101.SP" is beside
/// "AI101.PV" and "AI101": its name has `ending` in place of PV, SP or OP, or after an added point. None if
/// there is no such column.
std::optional<std::size_t> column_beside(const RecordColumns& file, std::size_t column,
                                         const std::string& ending);

/// If several columns have the same heading of a quality, each belongs to the column before it and is renamed
/// to "xD.Status".
void name_repeated_qualities(RecordColumns& file);

}  // namespace mpm
