#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <catch2/catch.hpp>
#include <unistd.h>

#include "analysis/indicators/diagnosis.hpp"
#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/sweep_file.hpp"
#include "base/error.hpp"
#include "tests/scenarios/study_texts.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

/// A folder with the small study and a sweep over it.
class SweepFolder {
 public:
  explicit SweepFolder(const std::string& variants)
      : folder_(fs::temp_directory_path() / ("mpmbench-sweep-" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "small.toml") << testing::small_study();
    std::ofstream(file()) << "[sweep]\nname = \"s\"\ntitle = \"t\"\nstudy = \"small.toml\"\n" << variants;
  }
  ~SweepFolder() { fs::remove_all(folder_); }
  SweepFolder(const SweepFolder&) = delete;
  SweepFolder& operator=(const SweepFolder&) = delete;

  fs::path file() const { return folder_ / "sweep.toml"; }

 private:
  fs::path folder_;
};

std::string sweep_refusal(const std::string& variants) {
  const SweepFolder folder(variants);
  try {
    load_sweep(folder.file());
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

const std::string kVariant = "[[variant]]\nchoice = \"noise\"\nvalue = \"none\"\n";

}  // namespace

TEST_CASE("a variant is the base study with some keys laid over", "[sweep_file]") {
  const SweepFolder folder(
      kVariant + "set.simulation.noise_standard_deviation = 0.0\n" +
      "set.simulation.random_steps = {interval = {constant = 9}, level = {constant = 1}}\n" +
      "remove = [\"simulation.step\"]\n");
  const Sweep sweep = load_sweep(folder.file());
  REQUIRE(sweep.variants.size() == 2);
  const Study& base = sweep.variants[0].study;
  const Study& variant = sweep.variants[1].study;
  CHECK(sweep.variants[0].choice.empty());
  CHECK(base.source == testing::small_study());
  CHECK(sweep.variants[1].choice == "noise");
  CHECK(sweep.variants[1].value == "none");
  CHECK(variant.simulation.noise_standard_deviation.isZero(0.0));
  CHECK(variant.simulation.steps.empty());
  CHECK(variant.simulation.random_steps);
  CHECK_FALSE(base.simulation.steps.empty());
  CHECK(variant.simulation.samples == base.simulation.samples);
  CHECK(variant.controller.cv_soft.lower == base.controller.cv_soft.lower);
  // The text of a variant is a study of its own.
  CHECK(parse_study(variant.source, "variant").simulation.noise_standard_deviation.isZero(0.0));
}

TEST_CASE("the base study of a sweep may be changed for all of its lines", "[sweep_file]") {
  const SweepFolder folder(
      "set.study.seed = 99\nremove = [\"simulation.step\"]\n"
      "set.simulation.random_steps = {interval = {constant = 9}, level = {constant = 1}}\n" +
      kVariant + "set.simulation.noise_standard_deviation = 0.0\n");
  const Sweep sweep = load_sweep(folder.file());
  for (const SweepVariant& variant : sweep.variants) {
    CHECK(variant.study.seed == 99);
    CHECK(variant.study.simulation.steps.empty());
  }
  CHECK_FALSE(sweep.variants[0].study.simulation.noise_standard_deviation.isZero(0.0));
  CHECK(sweep_refusal("remove = [\"simulation.steps\"]\n").find("keys that the base study has") !=
        std::string::npos);
}

TEST_CASE("a table that the base study does not have is added", "[sweep_file]") {
  const SweepFolder folder(kVariant + "set.diagnosis.mpm_threshold = 0.2\n");
  CHECK(mpm_threshold(load_sweep(folder.file()).variants[1].study) == 0.2);
}

TEST_CASE("what is no sweep is refused by its key", "[sweep_file]") {
  CHECK_THAT(sweep_refusal(kVariant), Catch::Contains("variant[0].set"));
  CHECK_THAT(sweep_refusal(kVariant + "set = 3\n"),
             Catch::Contains("found 3; allowed: a table of study keys"));
  CHECK_THAT(sweep_refusal(kVariant + "set.simulation.samples = 50\n"),
             Catch::Contains("(noise = none)") && Catch::Contains("simulation.samples: found 50"));
  CHECK_THAT(sweep_refusal(kVariant + "set.simulation.sample = 50\n"), Catch::Contains("nearest: 'samples'"));
  CHECK_THAT(sweep_refusal(kVariant + "set.simulation.samples = 80\nremove = [\"simulation.steps\"]\n"),
             Catch::Contains("'simulation.steps'"));
  CHECK_THAT(sweep_refusal(kVariant + "set.simulation.samples = 80\nremove = \"a\"\n"),
             Catch::Contains("a list of keys"));
  CHECK_THAT(sweep_refusal("[[variants]]\n"), Catch::Contains("nearest: 'variant'"));
  CHECK_THROWS_AS(load_sweep("no-such-sweep.toml"), InputError);
}

TEST_CASE("each variant of the shipped sweep is another study, and the variants of a choice stand together",
          "[sweep_file]") {
  const Sweep sweep = find_sweep("chapter6");
  CHECK(sweep.variants.front().study.name == "chapter6");
  std::set<std::string> texts, choices;
  std::string last;
  for (const SweepVariant& variant : sweep.variants) {
    INFO(variant.choice << " = " << variant.value);
    CHECK(texts.insert(variant.study.source).second);
    if (variant.choice != last)
      CHECK(choices.insert(variant.choice).second);
    last = variant.choice;
  }
  CHECK(choices.size() >= 7);  // weights, slack, noise, length, excitation, amplitude of v, windows
}

}  // namespace mpm
