#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <catch2/catch.hpp>

#include "analysis/study_aggregate.hpp"
#include "campaign_sample.hpp"
#include "results/archive.hpp"
#include "results/archive_error.hpp"
#include "results/summary.hpp"

namespace {

using namespace mpm;
namespace fs = std::filesystem;

/// A folder of its own that goes away with the test.
struct Folder {
  fs::path path = fs::temp_directory_path() / ("mpmbench-results-" + std::to_string(std::rand()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
};

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

void write(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

bool same_bits(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

const Campaign& sample() {
  static const Campaign campaign = campaign_sample();
  return campaign;
}

TEST_CASE("archive: what is written is read again bit for bit") {
  const Folder folder;
  const fs::path path = folder.path / "a.h5";
  write_archive(path, sample());
  const Campaign read = read_archive(path);
  CHECK(read.study.seed == sample().study.seed);
  CHECK(read.study.source == sample().study.source);
  CHECK(read.info.solver == "active-set");
  CHECK(read.basis.healthy == sample().basis.healthy);
  CHECK(same_bits(read.basis.trajectory.y, sample().basis.trajectory.y));
  CHECK(same_bits(read.basis.sensitivity.step_response[1], sample().basis.sensitivity.step_response[1]));
  REQUIRE(read.records.size() == sample().records.size());
  for (std::size_t i = 0; i < read.records.size(); ++i) {
    const ExperimentRecord& a = read.records[i];
    const ExperimentRecord& b = sample().records[i];
    CHECK(a.draw.index == b.draw.index);
    CHECK(a.draw.kind == b.draw.kind);
    CHECK(a.draw.true_cv() == b.draw.true_cv());
    CHECK(a.status == b.status);
    CHECK(a.message == b.message);
    CHECK(same_bits(a.diagnosis.ivar, b.diagnosis.ivar));
    CHECK(same_bits(a.diagnosis.ivar_diag, b.diagnosis.ivar_diag));
    CHECK(same_bits(a.diagnosis.ivar_basis, b.diagnosis.ivar_basis));
    CHECK(a.diagnosis.predicted_cv == b.diagnosis.predicted_cv);
    CHECK(std::memcmp(&a.diagnosis.indicator.i_mpm, &b.diagnosis.indicator.i_mpm, sizeof(double)) == 0);
    CHECK(a.solver.steps == b.solver.steps);
    CHECK(a.loop.has_value() == b.loop.has_value());
    if (a.loop)
      CHECK(same_bits(a.loop->trajectory.y, b.loop->trajectory.y));
  }
  CHECK(summary_text(read, "x") == summary_text(sample(), "x"));
}

TEST_CASE("archive: the same campaign gives the same bytes") {
  const Folder folder;
  write_archive(folder.path / "a.h5", sample());
  write_archive(folder.path / "b.h5", sample());
  CHECK(content(folder.path / "a.h5") == content(folder.path / "b.h5"));
}

TEST_CASE("archive: an unwritable path leaves nothing behind") {
  const Folder folder;
  write(folder.path / "file", "x");
  CHECK_THROWS_AS(write_archive(folder.path / "file" / "a.h5", sample()), ArchiveError);
  CHECK_THROWS_AS(write_archive(folder.path / "none" / "a.h5", sample()), ArchiveError);
  CHECK(std::distance(fs::directory_iterator(folder.path), {}) == 1);
}

TEST_CASE("archive: what is no archive is refused by name, whatever it is") {
  const Folder folder;
  const fs::path path = folder.path / "a.h5";
  CHECK_THROWS_WITH(read_archive(path), Catch::Contains("a.h5"));
  write(path, "no HDF5 at all");
  CHECK_THROWS_AS(read_archive(path), ArchiveError);
  write_archive(path, sample());
  const std::string whole = content(path);
  for (int cut = 0; cut < 24; ++cut) {
    write(path, whole.substr(0, whole.size() * static_cast<std::size_t>(cut) / 24));
    CHECK_THROWS_AS(read_archive(path), ArchiveError);
  }
}

}  // namespace
