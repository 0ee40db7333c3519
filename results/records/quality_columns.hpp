#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "results/records/record_columns.hpp"

namespace mpm {

/// The column that has the quality of another one by its heading: "xD.Status", "xD_Quality", "Status xD",
/// also of "xD.PV" or "xD.Value"; otherwise the one column of qualities (are_qualities()) that is called
/// "quality" or "status". None where there is none of these, or several.
std::optional<std::size_t> quality_column_of(const RecordColumns& file, std::size_t column);

/// Is this column one of qualities whatever its heading says: one cell at least is good (is_good_opc()), and
/// each that is a number is a code of OPC DA or UA? An empty cell says nothing.
bool are_qualities(const RecordColumns& file, std::size_t column);

/// The column that a historian has beside another one of a tag, as "AI101.SP" is beside "AI101.PV" and
/// "AI101": that of the same name with `ending` instead of PV, SP or OP, or behind a point. None: there is
/// none.
std::optional<std::size_t> column_beside(const RecordColumns& file, std::size_t column,
                                         const std::string& ending);

/// Headings of qualities that stand there several times belong to the column before each: "xD.Status".
void name_repeated_qualities(RecordColumns& file);

}  // namespace mpm
