#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "results/records/record_columns.hpp"
#include "scenarios/study/data_options.hpp"

namespace mpm {

/// Returns the columns of a CSV text of records as [data] says: parse_csv() with numbers in the form of the
/// file.
RecordColumns csv_record_columns(std::string_view text, const std::string& file, const DataOptions& data);

/// Returns the columns of a file of records: CSV, netCDF-4 (netcdf_columns()) or MATLAB 7.3
/// (matlab_columns()). Errors: those of these functions, and InputError if the file cannot be read.
RecordColumns load_record_columns(const std::filesystem::path& path, const DataOptions& data);

}  // namespace mpm
