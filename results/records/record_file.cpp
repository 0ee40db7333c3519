#include "results/records/record_file.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "base/error.hpp"
#include "results/files/foreign_content.hpp"
#include "results/records/csv_columns.hpp"
#include "results/records/netcdf_columns.hpp"

namespace mpm {
namespace {

constexpr const char* kConvertNetcdf = "a netCDF-4 file: nccopy -k nc4 OLD.nc NEW.nc";
constexpr const char* kSaveSheet = "a CSV file: save the sheet as \"CSV UTF-8\"";
constexpr const char* kUnpack = "the file in it: unpack it first";
constexpr const char* kByPandas =
    "a CSV file, or a DataFrame: pandas reads it, and mpmbench.assess() takes it (docs/python.md)";

/// A format that people bring but that is not read here: how its files begin, its name, and what to do.
struct OtherFormat {
  std::string_view begins, name, allowed;
};

constexpr std::array kOtherFormats{
    OtherFormat{"CDF\x01", "a netCDF-3 file", kConvertNetcdf},
    OtherFormat{"CDF\x02", "a netCDF-3 file", kConvertNetcdf},
    OtherFormat{"CDF\x05", "a netCDF-3 file", kConvertNetcdf},
    OtherFormat{"MATLAB 5.0", "a MAT-file of MATLAB 5 to 7.2",
                "one of MATLAB 7.3: load it, and save(\"NEW.mat\", \"-v7.3\")"},
    OtherFormat{"PK\x03\x04", "a ZIP archive, as a spreadsheet is one", kSaveSheet},
    OtherFormat{"\xD0\xCF\x11\xE0", "a spreadsheet of an old Excel", kSaveSheet},
    OtherFormat{"\x1F\x8B", "a gzip archive", kUnpack},
    OtherFormat{"BZh", "a bzip2 archive", kUnpack},
    OtherFormat{"\xFD\x37zXZ", "an xz archive", kUnpack},
    OtherFormat{"\x28\xB5\x2F\xFD", "a zstd archive", kUnpack},
    OtherFormat{"PAR1", "a Parquet file", kByPandas},
    OtherFormat{"ARROW1", "an Arrow file", kByPandas},
    OtherFormat{"SQLite format 3", "a database of SQLite", kByPandas}};

void refuse_other_format(std::string_view content, const std::string& file) {
  for (const OtherFormat& format : kOtherFormats)
    if (content.starts_with(format.begins))
      throw InputError(file, std::string(format.name), std::string(format.allowed));
}

}  // namespace

RecordColumns csv_record_columns(std::string_view text, const std::string& file, const DataOptions& data) {
  RecordColumns columns = parse_csv(text, file, {.separator = data.separator, .skip = data.skip});
  find_number_form(columns, data.decimal.empty() ? '\0' : data.decimal.front());
  return columns;
}

RecordColumns load_record_columns(const std::filesystem::path& path, const DataOptions& data) {
  const std::string content =
      foreign_content(path, "a CSV, netCDF-4 or MATLAB 7.3 file of records (docs/own_records.md)");
  const std::string file = path.filename().string();
  if (!is_hdf5(content)) {
    refuse_other_format(content, file);
    return csv_record_columns(content, file, data);
  }
  const auto bytes = std::as_bytes(std::span(content));
  return netcdf_columns({bytes.begin(), bytes.end()}, file, data.time);
}

}  // namespace mpm
