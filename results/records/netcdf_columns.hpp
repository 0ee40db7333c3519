#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "results/records/record_columns.hpp"

namespace mpm {

/// Does a file that begins so hold HDF5, as netCDF-4 and MATLAB 7.3 do?
bool is_hdf5(std::string_view content);

/// The variables of a netCDF-4 file that run along its time, as columns:
///
/// | variable       | columns                                                          |
/// |----------------|------------------------------------------------------------------|
/// | x(time)        | x                                                                |
/// | x(c, time)     | x.NAME of each coordinate of c, or x.1, x.2, ... without names   |
/// | x(1, c, time)  | the same: one loop                                               |
/// | q(time, n)     | q, if its values are single characters                           |
/// | others         | none                                                             |
///
/// Time is the dimension of the variable `time`; empty: of one with a usual name, otherwise of "sample".
/// Times with CF units "UNIT since DATE" are written as dates of UTC, others stay numbers. _FillValue,
/// missing_value and NaN are empty cells, scale_factor and add_offset are applied. Groups are not looked
/// into. A file of MATLAB is read as matlab_columns() says.
///
/// The file is read in a process that is forked off, since HDF5 crashes on some damaged files and comes to no
/// end with others: to be called where there are no other threads. It has `time_limit` seconds.
///
/// Errors: InputError that names the file, the variable and what to do: no HDF5 file, no time, another
/// calendar than the usual one, several loops, no variable along the time, one that is not as long as it, an
/// attribute of another kind, values in another file, too many values; HDF5 crashed or took too long.
RecordColumns netcdf_columns(std::vector<std::byte> content, const std::string& file, const std::string& time,
                             double time_limit = 120.0);

}  // namespace mpm
