#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "base/error.hpp"
#include "bench/parts/launcher.hpp"
#include "bench/parts/loop_ranges.hpp"
#include "bench/parts/part_folder.hpp"

namespace {

using namespace mpm;
using Catch::Contains;

using Variables = std::map<std::string, std::string>;

PartNumber parsed(const std::string& text, const Variables& variables = {}) {
  return parse_part(text, [&](const char* name) {
    const auto found = variables.find(name);
    return found != variables.end() ? std::optional(found->second) : std::nullopt;
  });
}

using Piece = std::pair<std::int64_t, std::int64_t>;

Piece shard(const std::string& text, const Variables& variables = {}) {
  const PartNumber number = parsed(text, variables);
  return {number.number, number.of};
}

Variables array_task(const std::string& task, const std::string& least, const std::string& most,
                     const std::string& count) {
  return {{"SLURM_ARRAY_TASK_ID", task},  {"SLURM_ARRAY_TASK_MIN", least},
          {"SLURM_ARRAY_TASK_MAX", most}, {"SLURM_ARRAY_TASK_COUNT", count},
          {"SLURM_PROCID", "0"},  // of the batch script itself: no task of srun
          {"SLURM_NTASKS", "4"}};
}

TEST_CASE("loop ranges: a text and back, neighbours as one range") {
  for (const std::string text : {"0:1", "3:7", "0:2,3:10"})
    CHECK(to_string(parse_loop_ranges(text, 10)) == text);
  CHECK(to_string(parse_loop_ranges("0:2,2:5", 10)) == "0:5");
  CHECK(to_string(LoopRanges()).empty());
  CHECK(ranges_of({1, 2, 3, 7, 9, 10}) == LoopRanges{{1, 4}, {7, 8}, {9, 11}});
  CHECK(indices_in({{1, 3}, {7, 9}}) == std::vector<std::int64_t>{1, 2, 7, 8});
}

TEST_CASE("loop ranges: what is none is refused with what is allowed") {
  for (const char* text : {"", ":", "1", "1:", ":1", "1:1", "2:1", "0:11", "-1:2", "a:b", "1:2,", ",1:2",
                           "1:3,2:4", "1:2;3:4", "0:99999999999999999999", "1 :2"})
    CHECK_THROWS_WITH(parse_loop_ranges(text, 10), Contains("--range") && Contains("0 to 10"));
}

TEST_CASE("loop ranges: pieces are all of them, in order, and differ by one loop at most") {
  for (const LoopRanges& all : {LoopRanges{{0, 34}}, LoopRanges{{3, 4}, {10, 21}, {22, 29}}, LoopRanges{}})
    for (std::int64_t of = 1; of < 40; ++of) {
      std::vector<std::int64_t> together;
      for (std::int64_t number = 1; number <= of; ++number) {
        const LoopRanges piece = piece_of(all, number, of);
        const std::int64_t least = size_of(all) / of;
        CHECK((size_of(piece) == least || size_of(piece) == least + 1));
        for (const std::int64_t index : indices_in(piece))
          together.push_back(index);
      }
      CHECK(together == indices_in(all));
    }
  const std::int64_t many = std::int64_t{1} << 60;  // no product overflows
  CHECK(piece_of({{0, many}}, 1 << 30, 1 << 30).back().end == many);
}

TEST_CASE("shard: a number of a number") {
  CHECK(shard("1/1") == Piece{1, 1});
  CHECK(shard("3/8", {{"PMI_RANK", "0"}, {"PMI_SIZE", "2"}}) == Piece{3, 8});  // the user knows better
  for (const char* text : {"", "/", "1", "0/2", "3/2", "-1/2", "1/0", "1/2/3", "1/-2", "a/2", "01/2", "1/02",
                           "1/99999999999", "auto/", "auto/0", "auto/x", "Auto", "autos"})
    CHECK_THROWS_WITH(shard(text), Contains("--shard"));
}

TEST_CASE("shard: auto takes rank and size from whatever launched it") {
  CHECK(shard("auto", {{"OMPI_COMM_WORLD_RANK", "1"}, {"OMPI_COMM_WORLD_SIZE", "4"}}) == Piece{2, 4});
  CHECK(shard("auto", {{"PMI_RANK", "0"}, {"PMI_SIZE", "4"}}) == Piece{1, 4});
  CHECK(shard("auto", {{"SLURM_PROCID", "2"}, {"SLURM_STEP_NUM_TASKS", "3"}}) == Piece{3, 3});
  CHECK(shard("auto/3", {{"SLURM_PROCID", "2"}, {"SLURM_STEP_NUM_TASKS", "3"}}) == Piece{3, 3});
  CHECK(shard("auto", array_task("5", "1", "8", "8")) == Piece{5, 8});
  CHECK(shard("auto/8", array_task("5", "3", "5", "2")) == Piece{5, 8});  // --array=3,5 of 1-8
  CHECK(shard("auto/8", {{"JOB_COMPLETION_INDEX", "7"}}) == Piece{8, 8});

  // mpirun in a job of Slurm is started by a step of srun of its own, with one task a node.
  CHECK(shard("auto", {{"OMPI_COMM_WORLD_RANK", "1"},
                       {"OMPI_COMM_WORLD_SIZE", "2"},
                       {"SLURM_PROCID", "0"},
                       {"SLURM_STEP_NUM_TASKS", "1"}}) == Piece{2, 2});
  Variables both = array_task("2", "1", "3", "3");
  both["SLURM_PROCID"] = "3";
  both["SLURM_STEP_NUM_TASKS"] = "4";
  CHECK(shard("auto", both) == Piece{8, 12});
  CHECK_THAT(parsed("auto", both).launcher,
             Contains("task 2 of 3 of a Slurm array") && Contains("task 4 of 4"));
}

TEST_CASE("shard: a whole Slurm array counts from wherever it begins, by its step") {
  for (const std::int64_t first : {0, 1, 3, 100})
    for (const std::int64_t step : {1, 2, 7})
      for (const std::int64_t of : {1, 2, 4, 9})
        for (std::int64_t place = 0; place < of; ++place) {
          const auto text = [&](std::int64_t at) { return std::to_string(first + at * step); };
          Variables array = array_task(text(place), text(0), text(of - 1), std::to_string(of));
          array["SLURM_ARRAY_TASK_STEP"] = std::to_string(step);
          CHECK(shard("auto", array) == Piece{place + 1, of});
          CHECK(shard(fmt::format("auto/{}", of), array) == Piece{place + 1, of});
        }
  CHECK(shard("auto", array_task("0", "0", "3", "4")) == Piece{1, 4});
  // Some tasks of N once more: those of an array 1-N, or of 0-(N-1) when task 0 is one of them.
  CHECK(shard("auto/8", array_task("3", "3", "5", "2")) == Piece{3, 8});
  CHECK(shard("auto/8", array_task("8", "8", "8", "1")) == Piece{8, 8});
  CHECK(shard("auto/8", array_task("0", "0", "5", "2")) == Piece{1, 8});
  CHECK(shard("auto/8", array_task("5", "0", "5", "2")) == Piece{6, 8});
}

TEST_CASE("shard: where a launcher does not say enough, auto says what it needs") {
  CHECK_THROWS_WITH(shard("auto"), Contains("no launcher") && Contains("mpirun"));
  CHECK_THROWS_WITH(shard("auto", {{"SLURM_PROCID", "0"}, {"SLURM_NTASKS", "8"}}), Contains("no launcher"));
  CHECK_THROWS_WITH(shard("auto", array_task("5", "3", "5", "2")), Contains("auto/N"));
  CHECK_THROWS_WITH(shard("auto", array_task("3", "1", "9", "5")), Contains("--array=1-N"));  // 1-9:2
  CHECK_THROWS_WITH(shard("auto/8", array_task("9", "1", "9", "9")), Contains("1 to 8"));
  CHECK_THROWS_WITH(shard("auto/8", array_task("8", "0", "8", "9")), Contains("0 to 7"));
  CHECK_THROWS_WITH(shard("auto", array_task("4", "0", "9223372036854775807", "9223372036854775807")),
                    Contains("--array=1-N"));
  CHECK_THROWS_WITH(shard("auto", {{"JOB_COMPLETION_INDEX", "7"}}), Contains("auto/N"));
  CHECK_THROWS_WITH(shard("auto/7", {{"JOB_COMPLETION_INDEX", "7"}}), Contains("0 to 6"));
  CHECK_THROWS_WITH(shard("auto/3", {{"PMI_RANK", "0"}, {"PMI_SIZE", "4"}}), Contains("auto/4"));
  CHECK_THROWS_WITH(shard("auto", {{"PMI_RANK", "4"}, {"PMI_SIZE", "4"}}),
                    Contains("4 of 4") && Contains("0 to 3"));
  CHECK_THROWS_WITH(shard("auto", {{"PMI_RANK", "x"}, {"PMI_SIZE", "4"}}),
                    Contains("PMI_RANK") && Contains("a whole number"));
}

TEST_CASE("part: its folder is named by what was asked for, however long that is") {
  CHECK(part_name("", PartNumber{3, 8, ""}) == "3-of-8");
  CHECK(part_name("100:150,160:170", std::nullopt) == "100-150+160-170");
  CHECK(part_name("100:150", PartNumber{1, 2, ""}) == "100-150_1-of-2");
  std::string one = "0:1";
  for (int i = 1; i < 100; ++i)
    one += fmt::format(",{}:{}", 2 * i, 2 * i + 1);
  const std::string other = fmt::format("{},300:301", one);
  CHECK(part_name(one, std::nullopt).size() < 40);
  CHECK(part_name(one, std::nullopt) != part_name(other, std::nullopt));
}

}  // namespace
