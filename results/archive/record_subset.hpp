#pragma once

#include <string>
#include <vector>

#include "analysis/experiment/experiment.hpp"
#include "results/archive/hdf5_file.hpp"

namespace mpm {

/// The records of the experiments whose indices are the coordinates of a dimension of /`group_name`, such as
/// `stored` of /trajectories, in that order. Throws ArchiveError unless they are experiments of the root
/// group in their order, each once; `file` is for its message.
std::vector<ExperimentRecord*> records_along(const Hdf5Group& group, const std::string& group_name,
                                             const std::string& dimension,
                                             std::vector<ExperimentRecord>& records, const std::string& file);

}  // namespace mpm
