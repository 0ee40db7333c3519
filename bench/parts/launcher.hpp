#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace mpm {

/// One of the parts into which work is split.
struct PartNumber {
  std::int64_t number = 1;  ///< from 1 to `of`
  std::int64_t of = 1;
  std::string launcher;  ///< who said so: "Slurm array task 3 of 8"; empty for the command line
};

/// The value of a variable of the environment; none when it is not set.
using Environment = std::function<std::optional<std::string>(const char* name)>;

/// That of this process.
std::optional<std::string> process_environment(const char* name);

/// Reads the option --shard:
///
/// | text | which part |
/// |---|---|
/// | I/N | number I of N, from 1 on |
/// | auto | as the launcher says that started this process, one of several |
/// | auto/N | the same, of N tasks: where a launcher does not say so, or only some tasks run again |
///
/// Launchers, by the variables that they set: first one that counts its tasks, of Open MPI
/// (OMPI_COMM_WORLD_RANK, _SIZE), MPICH and others with its process manager (PMI_RANK, PMI_SIZE), Slurm's
/// srun (SLURM_PROCID, SLURM_STEP_NUM_TASKS); around it the tasks of a Slurm array (SLURM_ARRAY_TASK_ID,
/// _MIN, _MAX, _STEP, _COUNT) or of an indexed Kubernetes job (JOB_COMPLETION_INDEX). A whole array A-B:STEP
/// is counted as it is; with auto/N where only some of N tasks run, they are those of an array 1-N, or
/// 0-(N-1) when task 0 runs. A task of an array that starts R processes has R of the R N parts. The program
/// is not linked with any of them.
///
/// Throws InputError for another text, for `auto` without a launcher, and for an array whose size is not
/// known.
PartNumber parse_part(std::string_view text, const Environment& environment);

/// True when the item at this place of a sequence belongs to the part. Every Nth is, from the
/// Ith on; all are without a part.
bool is_in_part(std::size_t place, const std::optional<PartNumber>& part);

}  // namespace mpm
