#include "results/records/record_file.hpp"

#include <cstddef>
#include <span>

#include "results/files/foreign_content.hpp"
#include "results/records/csv_columns.hpp"
#include "results/records/netcdf_columns.hpp"

namespace mpm {

RecordColumns csv_record_columns(std::string_view text, const std::string& file, const DataOptions& data) {
  RecordColumns columns = parse_csv(text, file, {.separator = data.separator, .skip = data.skip});
  find_number_form(columns, data.decimal.empty() ? '\0' : data.decimal.front());
  return columns;
}

RecordColumns load_record_columns(const std::filesystem::path& path, const DataOptions& data) {
  const std::string content =
      foreign_content(path, "a CSV, netCDF-4 or MATLAB 7.3 file of records (docs/own_records.md)");
  const std::string file = path.filename().string();
  if (!is_hdf5(content))
    return csv_record_columns(content, file, data);
  const auto bytes = std::as_bytes(std::span(content));
  return netcdf_columns({bytes.begin(), bytes.end()}, file, data.time);
}

}  // namespace mpm
