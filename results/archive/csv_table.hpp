#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "results/archive/campaign.hpp"
#include "results/archive/record_tables.hpp"

namespace mpm {

/// The tables of a campaign that can be written as CSV: "experiments" (one row an experiment: what was drawn,
/// how it ended, the truth, the verdicts), one a method under its name (its numbers), "findings", and "loops"
/// (one row a sample of each loop that was kept).
std::vector<std::string> csv_table_names(const Campaign& campaign);

/// A table as CSV (RFC 4180, UTF-8, '.' as decimal point, one heading line): flags as their words, CVs and
/// MVs by name, NaN for what does not exist. A variable with a dimension has a column for each of its
/// coordinates, "ivar.y1", "flagged.sse". Throws InputError for another name.
std::string csv_table(const Campaign& campaign, const std::string& name);
/// The same in pieces, so that neither the table nor the records of a campaign that is streamed have to be in
/// memory.
void write_csv_table(const Campaign& campaign, const std::string& name,
                     const std::function<void(std::string_view)>& write);

/// One row an experiment with the rows of those of these tables that belong to `group`.
void write_csv_records(const Campaign& campaign, const std::vector<RecordTable>& tables,
                       const std::string& group, const std::function<void(std::string_view)>& write);

}  // namespace mpm
