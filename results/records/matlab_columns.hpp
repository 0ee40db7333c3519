#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "results/archive/hdf5_file.hpp"
#include "results/records/record_columns.hpp"

namespace mpm {

inline constexpr std::size_t kMatlabHeading = 512;  ///< bytes before HDF5 in a MAT-file of MATLAB 7.3

/// Tells whether a file begins like a MAT-file of MATLAB 7.3.
bool is_matlab(std::string_view content);

/// Returns the variables of a MAT-file of MATLAB 7.3 (save -v7.3), and the fields of its scalar structs, as
/// columns:
///
/// | variable                             | columns                                                   |
/// |--------------------------------------|-----------------------------------------------------------|
/// | N x 1 or 1 x N numbers, also logical | x                                                         |
/// | N x c numbers                        | the names of a cell array of c texts, or x.1, x.2, ...    |
/// | N x 1 or 1 x N cell array of texts   | x                                                         |
/// | N x n characters                     | x, one text per row                                       |
/// | others                               | none                                                      |
///
/// N is the length of the variable `time`. If `time` is empty, N is the length of the variable with a usual
/// name for time, or else the largest number of rows. Fields of a struct keep their own names. NaN becomes an
/// empty cell.
///
/// Errors: InputError if the file has no such variable; ArchiveError if HDF5 cannot read it.
RecordColumns matlab_columns(const Hdf5Group& root, const std::string& file, const std::string& time);

}  // namespace mpm
