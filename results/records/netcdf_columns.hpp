#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "results/records/record_columns.hpp"

namespace mpm {

/// Tells whether a file that begins like this holds HDF5, as netCDF-4 and MATLAB 7.3 do.
bool is_hdf5(std::string_view content);

/// Returns the variables of a netCDF-4 file that run along its time, as columns:
///
/// | variable       | columns                                                          |
/// |----------------|------------------------------------------------------------------|
/// | x(time)        | x                                                                |
/// | x(c, time)     | x.NAME of each coordinate of c, or x.1, x.2, ... without names   |
/// | x(1, c, time)  | the same: one loop                                               |
/// | q(time, n)     | q, if its values are single characters                           |
/// | others         | none                                                             |
///
/// The time dimension is that of the variable `time`. If `time` is empty, it is that of a variable with a
/// usual name for time, or else "sample". Times with CF units "UNIT since DATE" are written as dates in UTC;
/// others stay numbers. _FillValue, missing_value and NaN become empty cells; scale_factor and add_offset are
/// applied. Groups are not read. A file of MATLAB is read by matlab_columns().
///
/// The file is read in a forked process, since HDF5 crashes on some damaged files and never ends with others.
/// Therefore call this only while there are no other threads. The process has `time_limit` seconds.
///
/// Errors: InputError that names the file, the variable and what to do, in these cases: no HDF5 file, no
/// time, an unusual calendar, several loops, no variable along the time, a variable of another length than
/// the time, an attribute of another type, values in another file, too many values, or HDF5 crashed or took
/// too long.
RecordColumns netcdf_columns(std::vector<std::byte> content, const std::string& file, const std::string& time,
                             double time_limit = 120.0);

}  // namespace mpm
