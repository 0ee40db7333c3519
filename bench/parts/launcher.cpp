#include "bench/parts/launcher.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include <fmt/format.h>

#include "base/error.hpp"
#include "bench/parts/whole_number.hpp"

namespace mpm {
namespace {

/// The number in a variable; none if the variable is not set. Throws InputError if its value is no number.
std::optional<std::int64_t> number_of(const Environment& environment, const char* name) {
  const std::optional<std::string> text = environment(name);
  if (!text)
    return std::nullopt;
  const std::optional<std::int64_t> number = whole_number_in(*text);
  if (!number)
    throw InputError(fmt::format("--shard auto: environment variable {}", name), fmt::format("'{}'", *text),
                     "a whole number");
  return number;
}

/// The most tasks that a launcher may have, so that products of such numbers do not overflow.
constexpr std::int64_t kMostTasks = std::numeric_limits<std::int32_t>::max();

/// A program that starts several processes and tells each its number, in these variables.
struct Launcher {
  const char* name;
  const char* number;
  const char* size;  ///< how many processes there are; null: it does not say
};

/// Launchers that start processes side by side and number them from 0 on.
constexpr Launcher kRanks[] = {{"rank {} of {} of Open MPI", "OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                               {"rank {} of {} of MPI", "PMI_RANK", "PMI_SIZE"},
                               {"task {} of {} of srun", "SLURM_PROCID", "SLURM_STEP_NUM_TASKS"}};

/// Launchers that start jobs, each of which may be several processes.
constexpr Launcher kArray{"task {} of {} of a Slurm array", "SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT"};
constexpr Launcher kPods{"pod {} of {} of a Kubernetes job", "JOB_COMPLETION_INDEX", nullptr};

/// The part of task `number` among `of` tasks, which are numbered from `first` on, `step` apart.
PartNumber part_by(const Launcher& launcher, std::int64_t number, std::int64_t of, std::int64_t first = 0,
                   std::int64_t step = 1) {
  const std::int64_t place = (number - first) / step;
  if (number < first || place >= of || of > kMostTasks)
    throw InputError(fmt::format("--shard auto: environment variable {}", launcher.number),
                     fmt::format("{} of {}", number, of),
                     fmt::format("{} to {}", first, first + (of - 1) * step));
  return {place + 1, of, fmt::format(fmt::runtime(launcher.name), place + 1, of)};
}

std::optional<PartNumber> rank_of(const Environment& environment) {
  for (const Launcher& launcher : kRanks)
    if (const auto number = number_of(environment, launcher.number),
        size = number_of(environment, launcher.size);
        number && size)
      return part_by(launcher, *number, *size);
  return std::nullopt;
}

[[noreturn]] void refuse_size(const Launcher& launcher, std::int64_t number) {
  throw InputError("--shard auto",
                   fmt::format("{} = {}, without the number of tasks", launcher.number, number),
                   "a whole array, sbatch --array=1-N; or --shard auto/N with the number of tasks or the "
                   "`completions` of the job");
}

/// The part of a task of an array. A whole array, A-B or A-B:STEP, is counted as it is. If only some of N
/// tasks run, they have the numbers of an array 1-N, or of an array 0-(N-1) if the array begins with task 0.
PartNumber array_task(const Environment& environment, std::int64_t number,
                      const std::optional<std::int64_t>& given) {
  const auto count = number_of(environment, kArray.size);
  const std::int64_t first = number_of(environment, "SLURM_ARRAY_TASK_MIN").value_or(1);
  const std::int64_t last = number_of(environment, "SLURM_ARRAY_TASK_MAX").value_or(0);
  const std::int64_t step =
      std::max<std::int64_t>(number_of(environment, "SLURM_ARRAY_TASK_STEP").value_or(1), 1);
  const bool is_whole = count && *count <= kMostTasks && step <= kMostTasks &&
                        last - first == (*count - 1) * step && (number - first) % step == 0;
  if (is_whole && given.value_or(*count) == *count)
    return part_by(kArray, number, *count, first, step);
  if (!given)
    refuse_size(kArray, number);
  return part_by(kArray, number, *given, std::min<std::int64_t>(first, 1));
}

std::optional<PartNumber> job_of(const Environment& environment, const std::optional<std::int64_t>& given) {
  if (const auto number = number_of(environment, kArray.number))
    return array_task(environment, *number, given);
  const auto number = number_of(environment, kPods.number);
  if (number && !given)
    refuse_size(kPods, *number);
  return number ? std::optional(part_by(kPods, *number, *given)) : std::nullopt;
}

PartNumber launched(const Environment& environment, const std::optional<std::int64_t>& given) {
  const std::optional<PartNumber> rank = rank_of(environment), job = job_of(environment, given);
  if (rank && job)
    return {(job->number - 1) * rank->of + rank->number, job->of * rank->of,
            fmt::format("{}, {}", job->launcher, rank->launcher)};
  if (job)
    return *job;
  if (!rank)
    throw InputError("--shard auto", "no launcher in the environment",
                     "a Slurm array, srun, mpirun or an indexed Kubernetes job; or --shard I/N");
  if (given && *given != rank->of)
    throw InputError("--shard", fmt::format("auto/{}", *given),
                     fmt::format("auto, or auto/{}: this is {}", rank->of, rank->launcher));
  return *rank;
}

[[noreturn]] void refuse(std::string_view text) {
  throw InputError("--shard", fmt::format("'{}'", text),
                   "I/N with 1 <= I <= N, auto, or auto/N with the number of tasks");
}

}  // namespace

std::optional<std::string> process_environment(const char* name) {
  const char* const value = std::getenv(name);
  return value != nullptr ? std::optional<std::string>(value) : std::nullopt;
}

PartNumber parse_part(std::string_view text, const Environment& environment) {
  constexpr std::string_view kAuto = "auto";
  if (text == kAuto)
    return launched(environment, std::nullopt);
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos)
    refuse(text);
  const std::optional<std::int64_t> of = whole_number_in(text.substr(slash + 1));
  if (!of || *of < 1 || *of > kMostTasks)
    refuse(text);
  if (text.substr(0, slash) == kAuto)
    return launched(environment, of);
  const std::optional<std::int64_t> number = whole_number_in(text.substr(0, slash));
  if (!number || *number < 1 || *number > *of)
    refuse(text);
  return {*number, *of, ""};
}

bool is_in_part(std::size_t place, const std::optional<PartNumber>& part) {
  return !part || static_cast<std::int64_t>(place) % part->of == part->number - 1;
}

}  // namespace mpm
