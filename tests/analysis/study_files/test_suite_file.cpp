#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <catch2/catch.hpp>
#include <unistd.h>

#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/suite_file.hpp"
#include "base/error.hpp"
#include "tests/scenarios/study_texts.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

/// A folder with the small study and a suite over it.
class SuiteFolder {
 public:
  explicit SuiteFolder(const std::string& rest)
      : folder_(fs::temp_directory_path() / ("mpmbench-suite-" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "small.toml") << testing::small_study();
    std::ofstream(file()) << "[suite]\nname = \"s\"\nversion = \"1.0\"\ntitle = \"t\"\nseed = 7\n" << rest;
  }
  ~SuiteFolder() { fs::remove_all(folder_); }
  SuiteFolder(const SuiteFolder&) = delete;
  SuiteFolder& operator=(const SuiteFolder&) = delete;

  fs::path file() const { return folder_ / "suite.toml"; }

 private:
  fs::path folder_;
};

std::string suite_refusal(const std::string& rest, const SuiteChoice& choice = {}) {
  const SuiteFolder folder(rest);
  try {
    load_suite(folder.file(), choice);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

std::string plant(const std::string& name) {
  return "[[plant]]\nname = \"" + name + "\"\nstudy = \"small.toml\"\n";
}

std::string family(const std::string& name, const std::string& changes = "") {
  return "[[family]]\nname = \"" + name + "\"\ntitle = \"title of " + name + "\"\n" + changes;
}

}  // namespace

TEST_CASE("a cell is the study of its plant with common changes, its family's and its own, in this order",
          "[suite_file]") {
  const SuiteFolder folder("[common]\nset.simulation = {samples = 110, noise_standard_deviation = 0.1}\n" +
                           plant("a") + plant("b") + family("f", "set.simulation.samples = 120\n") +
                           family("g", "plants = [\"b\"]\n") +
                           "[[cell]]\nplant = \"b\"\nfamily = \"f\"\nset.simulation.samples = 130\n");
  const Suite suite = load_suite(folder.file());
  REQUIRE(suite.cells.size() == 3);
  CHECK(suite.name_of(suite.cells[0]) == "a.f");
  CHECK(suite.name_of(suite.cells[1]) == "b.f");
  CHECK(suite.name_of(suite.cells[2]) == "b.g");
  CHECK(suite.cells[0].study.simulation.samples == 120);
  CHECK(suite.cells[1].study.simulation.samples == 130);
  CHECK(suite.cells[2].study.simulation.samples == 110);
  CHECK(suite.cells[1].study.simulation.noise_standard_deviation.maxCoeff() == 0.1);
  CHECK(suite.cells[1].study.name == "b-f");
  CHECK(suite.methods == std::vector<std::string>{"all"});
  // The text of a cell is a study of its own, with its seed.
  CHECK(parse_study(suite.cells[1].study.source, "cell") == suite.cells[1].study);
}

TEST_CASE(
    "each cell has a seed of its own, which a choice of cells does not change and the suite's seed does",
    "[suite_file]") {
  const SuiteFolder folder(plant("a") + plant("b") + family("f") + family("g"));
  std::set<std::uint64_t> seeds;
  for (const SuiteCell& cell : load_suite(folder.file()).cells) {
    CHECK(seeds.insert(cell.study.seed).second);
    CHECK(cell.study.seed < (std::uint64_t{1} << 53U));
  }
  const Suite part = load_suite(folder.file(), {.plants = {"b"}, .families = {"g"}});
  REQUIRE(part.cells.size() == 1);
  CHECK(part.cells[0].study.seed == load_suite(folder.file()).cells[3].study.seed);
  const Suite other = load_suite(folder.file(), {.seed = 8});
  CHECK(other.seed == 8);
  for (const SuiteCell& cell : other.cells)
    CHECK(seeds.count(cell.study.seed) == 0);
}

TEST_CASE("what is no suite is refused by its key", "[suite_file]") {
  CHECK(suite_refusal(plant("a") + family("f")) == "accepted");
  CHECK_THAT(suite_refusal(family("f")), Catch::Contains("plant"));
  CHECK_THAT(suite_refusal(plant("a") + plant("a") + family("f")),
             Catch::Contains("plant: found 'a' twice; allowed: every name once"));
  CHECK_THAT(suite_refusal(plant("a") + family("f") + family("f")),
             Catch::Contains("family: found 'f' twice"));
  CHECK_THAT(suite_refusal(plant("a") + family("f", "plants = [\"b\"]\n")),
             Catch::Contains("family[0].plants"));
  CHECK_THAT(suite_refusal(plant("a") + family("f", "set = 3\n")),
             Catch::Contains("family[0].set: found 3; allowed: a table of study keys"));
  CHECK_THAT(suite_refusal(plant("a") + family("f", "remove = [\"nothing\"]\n")),
             Catch::Contains("'nothing'"));
  CHECK_THAT(suite_refusal(plant("a") + family("f", "set.simulation.sample = 50\n")),
             Catch::Contains("(a.f)") && Catch::Contains("nearest: 'samples'"));
  const std::string two = plant("a") + plant("b") + family("f", "plants = [\"a\"]\n");
  CHECK_THAT(suite_refusal(two + "[[cell]]\nplant = \"b\"\nfamily = \"f\"\n"),
             Catch::Contains("cell[0].plant: found 'b'; allowed: a plant of the family"));
  const std::string cell = "[[cell]]\nplant = \"a\"\nfamily = \"f\"\n";
  CHECK_THAT(suite_refusal(two + cell + cell), Catch::Contains("a.f a second time"));
  CHECK_THAT(suite_refusal(two, {.plants = {"c"}}), Catch::Contains("plant of the suite: found 'c'"));
  CHECK_THAT(suite_refusal(two, {.families = {"e"}}), Catch::Contains("family of the suite: found 'e'"));
  CHECK_THAT(suite_refusal(two, {.plants = {"b"}}), Catch::Contains("cells of the suite: found none"));
  CHECK_THROWS_WITH(find_suite("standart"),
                    Catch::Contains("nearest: 'standard'") && Catch::Contains("quick"));
}

TEST_CASE("each cell of the shipped suites is another study with healthy loops", "[suite_file]") {
  for (const char* const name : {"standard", "exact", "quick"}) {
    const Suite suite = find_suite(name);
    CHECK(suite.name == name);
    std::set<std::string> texts;
    for (const SuiteCell& cell : suite.cells) {
      INFO(suite.name_of(cell));
      CHECK(texts.insert(cell.study.source).second);
      CHECK(cell.study.experiments.healthy > 0);
    }
  }
  CHECK(find_suite("standard").plants.size() >= 6);
}

TEST_CASE("every cell of the standard suite has worlds, and no cell of the suite exact", "[suite_file]") {
  for (const char* const name : {"standard", "quick"})
    for (const SuiteCell& cell : find_suite(name).cells) {
      REQUIRE(cell.study.world);
      CHECK(cell.study.world->count >= 8);
      REQUIRE(cell.study.calibration);
      CHECK(cell.study.calibration->worlds >= 40);  // a world for each loop: their scores are exchangeable
      CHECK(cell.study.calibration->healthy == cell.study.calibration->worlds);
      CHECK(cell.study.diagnosis.unstable == UnstableLoops::exclude);
    }
  for (const SuiteCell& cell : find_suite("exact").cells)
    CHECK_FALSE(cell.study.world);
}

}  // namespace mpm
