#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "analysis/study_files/study_file.hpp"
#include "analysis/study_files/study_library.hpp"
#include "base/error.hpp"
#include "tests/scenarios/study_texts.hpp"

namespace mpm {
namespace {

namespace fs = std::filesystem;

using namespace testing;

/// A folder of its own for each test, gone afterwards.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (fs::temp_directory_path() / "mpmbench-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) {
      throw std::runtime_error("no temporary folder");
    }
    path_ = pattern;
  }
  ~TemporaryFolder() { fs::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const fs::path& path() const { return path_; }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

 private:
  fs::path path_;
};

TEST_CASE("every shipped study can be read, under its own name", "[study_library]") {
  const std::vector<StudyEntry> studies = shipped_studies();
  REQUIRE(studies.size() >= 2);
  for (const StudyEntry& entry : studies) {
    const Study study = find_study(entry.name);
    CHECK(study.name == entry.name);
    CHECK(study.title == entry.title);
    CHECK(study.source == load_study(entry.path).source);
  }
}

TEST_CASE("chapter6 has the numbers of tables 6.2 and 6.4", "[study_library]") {
  const Study study = find_study("chapter6");
  CHECK(study.seed == 20150401);
  CHECK(study.plant.name == "shell-7x3");
  CHECK(study.controller.sample_time == 4);
  CHECK(study.controller.prediction_horizon == 75);
  CHECK(study.controller.control_horizon == 15);
  CHECK(study.controller.mv_cost == Eigen::Vector3d(8, 3, 4));
  CHECK(study.controller.target_weight == Eigen::Vector3d::Ones());
  CHECK(study.controller.move_suppression == Eigen::Vector3d::Constant(25));
  CHECK(study.controller.slack_weight == Eigen::VectorXd::Constant(7, 100));
  CHECK(study.controller.mv_hard.lower == Eigen::Vector3d::Constant(-0.5));
  CHECK(study.controller.mv_hard.upper == Eigen::Vector3d::Constant(0.5));
  CHECK(study.controller.cv_hard.lower == Eigen::VectorXd::Constant(7, -1));
  CHECK(study.controller.cv_hard.upper == Eigen::VectorXd::Constant(7, 1));
  Eigen::VectorXd soft(7);
  soft << 0, 0, -0.5, -0.5, -0.5, -0.5, -0.5;
  CHECK(study.controller.cv_soft.lower == soft);
  soft << 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0;
  CHECK(study.controller.cv_soft.upper == soft);
  CHECK(study.experiments.mpm == 150);
  CHECK(study.experiments.ud == 150);
  CHECK(study.experiments.mpm_ud == 100);
  CHECK(study.mismatch.gain_factor == Distribution::uniform(0.3, 1.5));
  CHECK(study.mismatch.time_constant_factor == Distribution::uniform(0.3, 3));
  CHECK(study.mismatch.dead_time_shift == Distribution::uniform(-2, 2));
  CHECK(study.disturbance.gain == Distribution::uniform(0.1, 3));
  CHECK(study.disturbance.time_constant == Distribution::uniform(30, 300));
}

TEST_CASE("wood-berry is a plant of its own whose optimum has both CVs at a limit", "[study_library]") {
  const Study study = find_study("wood-berry");
  const Eigen::MatrixXd K = study.plant.G.static_gain();
  CHECK(K == (Eigen::MatrixXd(2, 3) << 12.8, -18.9, 3.8, 6.6, -19.4, 4.9).finished());
  CHECK(study.plant.G(0, 2).dead_time() == 8.1);
  CHECK(study.plant.G(1, 2).denominator() == Eigen::Vector2d(13.2, 1));
  CHECK(study.experiments.total() == 40);

  // At y = 0, the lower limit of xD and the upper one of xB, the cost rises with xD and falls with xB
  // (multipliers of the LP (6.19)), and the MVs are free.
  const Eigen::Vector2d price = K.leftCols(2).transpose().inverse() * study.controller.mv_cost;
  CHECK(price(0) > 0);
  CHECK(price(1) < 0);
  CHECK(study.controller.cv_soft.lower(0) == 0);
  CHECK(study.controller.cv_soft.upper(1) == 0);
  const Eigen::Vector2d targets = -K.leftCols(2).inverse() * K.col(2) * study.simulation.step_level.maximum();
  CHECK(targets.cwiseAbs().maxCoeff() < study.controller.mv_hard.upper.minCoeff());
}

TEST_CASE("a study is found by path, by name, and by the name of a file", "[study_library]") {
  const TemporaryFolder folder;
  const fs::path path = folder.write("mine.toml", small_study());
  CHECK(find_study(path.string(), "no such folder").name == "small");
  CHECK(find_study("mine", folder.path()).name == "small");
  CHECK(find_study(folder.write("plain", small_study()).string(), folder.path()).name == "small");
}

TEST_CASE("an unknown study is refused with the known ones", "[study_library]") {
  CHECK_THROWS_WITH(find_study("chapter7"),
                    Catch::StartsWith("study: found 'chapter7' (nearest: 'chapter6'); "
                                      "allowed: a path, or one of ") &&
                        Catch::Contains("chapter6") && Catch::Contains("wood-berry"));
  CHECK_THROWS_AS(find_study(""), InputError);
}

TEST_CASE("a study file that cannot be read is refused by its path", "[study_library]") {
  const TemporaryFolder folder;
  const std::string missing = (folder.path() / "none.toml").string();
  CHECK_THROWS_WITH(find_study(missing), missing + ": found no such file; allowed: a study file");
  CHECK_THROWS_AS(load_study(folder.path()), InputError);  // a folder
  const std::string empty = folder.write("empty.toml", "").string();
  CHECK_THROWS_WITH(load_study(empty), empty + ":1: study: found nothing; allowed: a table");
  const std::string large = folder.write("large.toml", std::string(3 << 20, '\n')).string();
  CHECK_THROWS_WITH(load_study(large), Catch::StartsWith(large + ":1: TOML: found "));
  CHECK_THROWS_AS(shipped_studies(folder.path() / "none"), InputError);
}

TEST_CASE("the environment can name another folder of studies", "[study_library]") {
  const TemporaryFolder folder;
  folder.write("b.toml", small_study());
  folder.write("a.toml", small_study());
  folder.write("notes.txt", "no study");
  REQUIRE(setenv("MPMBENCH_STUDIES", folder.path().c_str(), 1) == 0);
  const std::vector<StudyEntry> studies = shipped_studies();
  REQUIRE(setenv("MPMBENCH_STUDIES", "", 1) == 0);
  REQUIRE(studies.size() == 2);
  CHECK(studies[0].name == "a");
  CHECK(studies[1].path == folder.path() / "b.toml");
  CHECK(studies[1].title == "A small study");
  CHECK(study_directory().filename() == "studies");  // an empty variable counts as none
  REQUIRE(unsetenv("MPMBENCH_STUDIES") == 0);
}

}  // namespace
}  // namespace mpm
