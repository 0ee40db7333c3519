#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scenarios/loop/plant_record.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// The records of the plant of `study` in a CSV text, as its [data] says (docs/own_records.md):
///
/// 1. Columns: that of the tag, or of the variable's name, also as `mpmbench export` writes it ("y.xD").
/// 2. Cells: numbers with the decimal sign of the file. What is no number, or has a quality that is not good,
///    is missing. A value of the study is scale (cell - operating point).
/// 3. Time stamps: ascending, or descending throughout. Without a column a row is a sample.
/// 4. Samples: every sample time from the first stamp on. A CV is the mean over the half of a sample time on
///    either side, or the nearest value; an MV, an MD, a setpoint, a limit the last value up to half a sample
///    time after the sample, since it is held. A CV without a value within is missing.
/// 5. A CV is also missing where the controller is off.
///
/// Errors: InputError, whose text names the file, the key or line, what was found and what to do, for a file
/// that cannot be read so, a CV or MV or MD without numbers, and one that is missing beyond
/// data.most_missing. What can be read and needs a look is a warning of the record.
PlantRecord read_plant_record(const Study& study, std::string_view text, const std::string& file);

/// The same of a file, CSV or netCDF-4 (netcdf_columns()). Errors: the same, for a file that cannot be read
/// as well.
PlantRecord load_plant_record(const Study& study, const std::filesystem::path& path);

}  // namespace mpm
