#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "results/archive/campaign.hpp"
#include "results/archive/record_tables.hpp"

namespace mpm {

/// The tables of a campaign that can be written as CSV: "experiments" (one row per experiment: what was
/// drawn, how it ended, the truth, the verdicts), one table per method under its name (its numbers),
/// "findings", and "loops" (one row per sample of each loop that was kept).
std::vector<std::string> csv_table_names(const Campaign& campaign);

/// Returns a table as CSV (RFC 4180, UTF-8, '.' as decimal point, one heading line). Flags are written as
/// their words, CVs and MVs by name, and missing values as NaN. A variable with a dimension has one column
/// for each of its coordinates, such as "ivar.y1" or "flagged.sse". Throws InputError if there is no table
/// `name`.
std::string csv_table(const Campaign& campaign, const std::string& name);
/// Writes the same table in pieces, so that neither the table nor the records of a streamed campaign have to
/// be in memory.
void write_csv_table(const Campaign& campaign, const std::string& name,
                     const std::function<void(std::string_view)>& write);

/// Writes one line per experiment, with the rows of those tables that belong to `group`.
void write_csv_records(const Campaign& campaign, const std::vector<RecordTable>& tables,
                       const std::string& group, const std::function<void(std::string_view)>& write);

}  // namespace mpm
