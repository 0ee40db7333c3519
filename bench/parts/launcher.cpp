#include "bench/parts/launcher.hpp"

#include <cstdlib>
#include <limits>

#include <fmt/format.h>

#include "bench/parts/whole_number.hpp"
#include "plants/error.hpp"

namespace mpm {
namespace {

/// The number in a variable; none when it is not set. Throws InputError when it is something else.
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

/// How many tasks a launcher may have: their products stay numbers.
constexpr std::int64_t kMostTasks = std::numeric_limits<std::int32_t>::max();

/// A launcher that starts all its tasks at once and counts them from 0 on.
struct Ranks {
  const char* rank;
  const char* size;
  const char* name;
};

constexpr Ranks kRanks[] = {{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", "rank {} of {} of Open MPI"},
                            {"PMI_RANK", "PMI_SIZE", "rank {} of {} of MPI"},
                            {"SLURM_PROCID", "SLURM_STEP_NUM_TASKS", "task {} of {} of srun"}};

std::optional<ShardNumber> rank_of(const Environment& environment) {
  for (const Ranks& ranks : kRanks) {
    const auto rank = number_of(environment, ranks.rank), size = number_of(environment, ranks.size);
    if (!rank || !size)
      continue;
    if (*rank < 0 || *rank >= *size || *size > kMostTasks)
      throw InputError(fmt::format("--shard auto: environment variables {} and {}", ranks.rank, ranks.size),
                       fmt::format("{} and {}", *rank, *size), "a rank from 0 on, and how many there are");
    return ShardNumber{*rank + 1, *size, fmt::format(fmt::runtime(ranks.name), *rank + 1, *size)};
  }
  return std::nullopt;
}

/// The task of a Slurm array. Its size is known without `given` only as long as it is whole.
std::optional<ShardNumber> array_task_of(const Environment& environment, std::optional<std::int64_t> given) {
  const auto task = number_of(environment, "SLURM_ARRAY_TASK_ID");
  if (!task)
    return std::nullopt;
  const auto count = number_of(environment, "SLURM_ARRAY_TASK_COUNT"),
             least = number_of(environment, "SLURM_ARRAY_TASK_MIN"),
             most = number_of(environment, "SLURM_ARRAY_TASK_MAX");
  const bool whole = least == 1 && most == count;
  if (!given && !whole)
    throw InputError("--shard auto", fmt::format("a Slurm array that is not 1-N, with task {}", *task),
                     "sbatch --array=1-N; or --shard auto/N where some of N tasks are run again");
  const std::int64_t of = given ? *given : *count;
  if (*task < 1 || *task > of)
    throw InputError("--shard auto: environment variable SLURM_ARRAY_TASK_ID", fmt::format("{}", *task),
                     fmt::format("1 to {}: sbatch --array=1-{}", of, of));
  return ShardNumber{*task, of, fmt::format("task {} of {} of a Slurm array", *task, of)};
}

/// The pod of an indexed Kubernetes job, which is told its index only.
std::optional<ShardNumber> pod_of(const Environment& environment, std::optional<std::int64_t> given) {
  const auto index = number_of(environment, "JOB_COMPLETION_INDEX");
  if (!index)
    return std::nullopt;
  if (!given)
    throw InputError("--shard auto", "an indexed Kubernetes job, which does not say how many pods it has",
                     "--shard auto/N with the `completions` of the job");
  if (*index < 0 || *index >= *given)
    throw InputError("--shard auto: environment variable JOB_COMPLETION_INDEX", fmt::format("{}", *index),
                     fmt::format("0 to {}", *given - 1));
  return ShardNumber{*index + 1, *given, fmt::format("pod {} of {} of a Kubernetes job", *index + 1, *given)};
}

ShardNumber launched(const Environment& environment, std::optional<std::int64_t> given) {
  const std::optional<ShardNumber> rank = rank_of(environment);
  std::optional<ShardNumber> outer = array_task_of(environment, given);
  if (!outer)
    outer = pod_of(environment, given);
  if (rank && outer)
    return {(outer->number - 1) * rank->of + rank->number, outer->of * rank->of,
            fmt::format("{}, {}", outer->launcher, rank->launcher)};
  if (outer)
    return *outer;
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

ShardNumber parse_shard(std::string_view text, const Environment& environment) {
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

bool is_in_shard(std::size_t place, const std::optional<ShardNumber>& shard) {
  return !shard || static_cast<std::int64_t>(place) % shard->of == shard->number - 1;
}

}  // namespace mpm
