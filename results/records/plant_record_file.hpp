#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scenarios/loop/plant_record.hpp"
#include "scenarios/study/study.hpp"

namespace mpm {

/// Reads the record of the plant of `study` from a CSV text, as its [data] says (docs/own_records.md):
///
/// 1. Columns: that of the tag, or of the variable's name, also as `mpmbench export` writes it ("y.xD").
/// 2. Cells: numbers with the decimal sign of the file. A cell that is no number, or whose quality is not
///    good, is missing. A value of the study is scale (cell - operating point).
/// 3. Time stamps: ascending or descending throughout. Without a column of stamps, each row is a sample.
/// 4. Samples: one every sample time from the first stamp on. A CV is the mean over the half sample time on
///    either side, or the nearest value in it; without a value there it is missing. An MV, an MD, a setpoint
///    and a limit are held: each is the last value up to half a sample time after the sample.
/// 5. A CV is also missing while the controller is off.
///
/// Errors: InputError, whose text names the file, the key or line, what was found and what to do, if a file
/// cannot be read like this, if a CV, MV or MD has no numbers, or if more of it is missing than
/// data.most_missing allows. Data that can be read but need a look give a warning in the record.
PlantRecord read_plant_record(const Study& study, std::string_view text, const std::string& file);

/// Reads the record from a file, CSV or netCDF-4 (netcdf_columns()). Errors: as above, and InputError if the
/// file cannot be read.
PlantRecord load_plant_record(const Study& study, const std::filesystem::path& path);

}  // namespace mpm
