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

/// The environment of this process.
std::optional<std::string> process_environment(const char* name);

/// Reads the option --shard:
///
/// | text | which part |
/// |---|---|
/// | I/N | number I of N, from 1 on |
/// | auto | the part that the launcher of this process names |
/// | auto/N | the same, of N tasks: if the launcher does not say how many, or only some tasks run again |
///
/// The variables that launchers set tell which one it is. The first kind counts its tasks: Open MPI
/// (OMPI_COMM_WORLD_RANK, _SIZE), MPICH and others with its process manager (PMI_RANK, PMI_SIZE), and Slurm's
/// srun (SLURM_PROCID, SLURM_STEP_NUM_TASKS). Around it there may be the tasks of a Slurm array
/// (SLURM_ARRAY_TASK_ID, _MIN, _MAX, _STEP, _COUNT) or of an indexed Kubernetes job (JOB_COMPLETION_INDEX). A
/// whole array A-B:STEP is counted as it is; with auto/N, if only some of N tasks run, they are those of an
/// array 1-N, or 0-(N-1) if task 0 runs. If each of N array tasks starts R processes, there are R N parts,
/// and each task has R of them. The program is not linked with any launcher.
///
/// Throws InputError for another text, for `auto` without a launcher, and for an array whose size is not
/// known.
PartNumber parse_part(std::string_view text, const Environment& environment);

/// Whether the item at this place of a sequence belongs to the part: every Nth item does, from the Ith on;
/// without a part, all items do.
bool is_in_part(std::size_t place, const std::optional<PartNumber>& part);

}  // namespace mpm
