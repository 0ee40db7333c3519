#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <catch2/catch.hpp>

#include "analysis/study_files/study_file.hpp"
#include "scenarios/loop/experiment_draw.hpp"
#include "scenarios/loop/historian.hpp"
#include "tests/scenarios/study_texts.hpp"

// What the historian makes of a record, each part by what defines it.

namespace mpm {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr Eigen::Index kRecordLength = 20000;

/// The small study with this [record], whose noise has the standard deviations 0.01 and 0.02.
Study recording_study(const std::string& record) {
  return parse_study(testing::replaced(testing::small_study(), "noise_standard_deviation = 0.01",
                                       "noise_standard_deviation = {level = 0.01, heat = 0.02}") +
                         "[record]\n" + record,
                     "s.toml");
}

/// A record of two CVs that grow, so that no two samples are alike.
Trajectory long_record() {
  Trajectory loop;
  loop.y.resize(2, kRecordLength);
  for (Eigen::Index k = 0; k < kRecordLength; ++k)
    loop.y.col(k) << 1.0 + 1e-3 * static_cast<double>(k), std::sin(0.01 * static_cast<double>(k));
  return loop;
}

Eigen::RowVectorXd row(std::initializer_list<double> values) {
  Eigen::RowVectorXd signal(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), signal.begin());
  return signal;
}

TEST_CASE("outliers: their share, their size, and every other sample as it was", "[historian]") {
  const Study study = recording_study("outliers = {share = 0.05, size = {constant = 8}}\n");
  const Trajectory loop = long_record();
  const Eigen::MatrixXd off = recorded(study, 3, loop).y - loop.y;
  for (Eigen::Index cv = 0; cv < 2; ++cv) {
    const double size = 8 * study.simulation.noise_standard_deviation(cv);
    const auto up = (off.row(cv).array() - size).abs() < 1e-9;
    const auto down = (off.row(cv).array() + size).abs() < 1e-9;
    CHECK((up || down || off.row(cv).array() == 0.0).all());
    // Binomial with p = 0.05: a standard deviation of 31 of 1000; half of them up.
    CHECK(std::abs(static_cast<double>((up || down).count()) - 1000.0) < 4 * 31);
    CHECK(std::abs(static_cast<double>(up.count()) - 500.0) < 4 * 22);
  }
  CHECK(recorded(study, 3, loop).y - loop.y == off);
  CHECK(recorded(study, 4, loop).y - loop.y != off);
  CHECK(recorded(study, kBasisIndex, loop).y - loop.y != off);
}

TEST_CASE("quantisation: whole multiples of the step, the nearest ones", "[historian]") {
  const Trajectory loop = long_record();
  const Eigen::MatrixXd y = recorded(recording_study("quantisation = 3\n"), 0, loop).y;
  const Eigen::ArrayXXd steps = Eigen::Vector2d(0.03, 0.06).asDiagonal().inverse() * y;
  CHECK((steps - steps.round()).abs().maxCoeff() < 1e-9);
  CHECK((y - loop.y).row(0).cwiseAbs().maxCoeff() <= 0.015 + 1e-12);
  CHECK((y - loop.y).row(1).cwiseAbs().maxCoeff() <= 0.030 + 1e-12);
}

TEST_CASE("missing samples: their share, the mean length of gaps, and the others as they were",
          "[historian]") {
  const Trajectory loop = long_record();
  const Eigen::MatrixXd y = recorded(recording_study("missing = {share = 0.2, length = 5}\n"), 1, loop).y;
  const auto missing = y.array().isNaN();
  CHECK((missing || y.array() == loop.y.array()).all());
  for (Eigen::Index cv = 0; cv < 2; ++cv) {
    Eigen::Index gaps = missing(cv, 0) ? 1 : 0;
    for (Eigen::Index k = 1; k < kRecordLength; ++k)
      gaps += missing(cv, k) && !missing(cv, k - 1) ? 1 : 0;
    const auto samples = static_cast<double>(missing.row(cv).count());
    // 800 gaps: the mean of geometric lengths, standard deviation sqrt(20), is known to 3 %; the share, to
    // which gaps and what lies between them contribute alike, to some 4 %.
    CHECK(samples / static_cast<double>(gaps) == Approx(5).epsilon(4 * 0.032));
    CHECK(samples / kRecordLength == Approx(0.2).epsilon(4 * 0.045));
  }
  CHECK((missing.row(0) != missing.row(1)).any());
}

TEST_CASE("gaps are filled by the last value, by a line, or not at all", "[historian]") {
  const Eigen::RowVectorXd gaps = row({kMissing, 1, kMissing, kMissing, 4, kMissing});
  CHECK(filled(gaps, GapFill::hold) == row({1, 1, 1, 1, 4, 4}));
  CHECK(filled(gaps, GapFill::linear).isApprox(row({1, 1, 2, 3, 4, 4}), 1e-15));
  CHECK(filled(gaps, GapFill::none).hasNaN());
  CHECK(filled(row({kMissing, kMissing}), GapFill::linear).array().isNaN().all());
  const Study study = recording_study("missing = {share = 0.6, length = 30, fill = 'linear'}\n");
  CHECK(recorded(study, 1, long_record()).y.allFinite());
}

TEST_CASE("compression: no sample is off by more than the deviation, and few points are archived",
          "[historian]") {
  const Trajectory loop = long_record();
  const Eigen::RowVectorXd wave =
      loop.y.row(1) + 1e-3 * loop.y.row(0).unaryExpr([](double x) { return std::sin(1e5 * x); });
  const double deviation = 0.01;
  const Eigen::RowVectorXd read = compressed(wave, deviation);
  CHECK((read - wave).cwiseAbs().maxCoeff() <= deviation * (1 + 1e-9));
  CHECK((read - wave).cwiseAbs().maxCoeff() > 0.5 * deviation);  // it does compress
  CHECK(read(0) == wave(0));
  CHECK(read(kRecordLength - 1) == wave(kRecordLength - 1));
  Eigen::Index corners = 0;
  for (Eigen::Index k = 1; k + 1 < kRecordLength; ++k)
    corners += std::abs(read(k + 1) - 2 * read(k) + read(k - 1)) > 1e-12 ? 1 : 0;
  CHECK(corners < kRecordLength / 20);
  CHECK(corners > 100);  // a sine of 32 periods has no fewer
  CHECK(compressed(wave, 0.0).isApprox(wave, 1e-12));
  CHECK(compressed(row({2}), 1) == row({2}));
  CHECK(compressed(row({0, 0, 0, 5, 0, 0}), 1) == row({0, 0, 0, 5, 0, 0}));  // a peak stays
}

TEST_CASE("compression goes from gap to gap", "[historian]") {
  const Study study = recording_study("compression = 2\nmissing = {share = 0.1, length = 3}\n");
  const Study gaps_alone = recording_study("missing = {share = 0.1, length = 3}\n");
  const Trajectory loop = long_record();
  const Eigen::MatrixXd y = recorded(study, 1, loop).y;
  CHECK((y.array().isNaN() == recorded(gaps_alone, 1, loop).y.array().isNaN()).all());
  const auto off = (y - loop.y).array().abs();
  CHECK((y.array().isNaN() || off <= 0.04 + 1e-12).all());
}

TEST_CASE("exception reporting: a value stays until one differs by more than the deviation", "[historian]") {
  CHECK(reported(row({0, 0.9, 1.1, 0.2, -1, 0}), 1) == row({0, 0, 1.1, 1.1, -1, -1}));
  const Trajectory loop = long_record();
  const Eigen::MatrixXd y = recorded(recording_study("exception = 2\n"), 1, loop).y;
  CHECK((y - loop.y).row(0).cwiseAbs().maxCoeff() <= 0.02 + 1e-12);
  CHECK((y.row(1).rightCols(kRecordLength - 1).array() == y.row(1).leftCols(kRecordLength - 1).array())
            .count() > kRecordLength / 2);
}

TEST_CASE("bad values: their share, what stands there, and gaps where their quality is known",
          "[historian]") {
  const Trajectory loop = long_record();
  const std::string spells = "bad = {share = 0.1, length = 4";
  const Eigen::MatrixXd off =
      recorded(recording_study(spells + ", value = 'off_scale', size = 30}\n"), 1, loop).y;
  const Eigen::MatrixXd stuck = recorded(recording_study(spells + "}\n"), 1, loop).y;
  const Eigen::MatrixXd known = recorded(recording_study(spells + ", quality = true}\n"), 1, loop).y;
  const auto bad = known.array().isNaN();
  for (Eigen::Index cv = 0; cv < 2; ++cv) {
    CHECK(static_cast<double>(bad.row(cv).count()) / kRecordLength == Approx(0.1).epsilon(0.2));
    const double far = 30 * (cv == 0 ? 0.01 : 0.02);
    for (Eigen::Index k = 0; k < kRecordLength; ++k) {
      REQUIRE(off(cv, k) == Approx(bad(cv, k) ? far : loop.y(cv, k)));
      REQUIRE(stuck(cv, k) == (bad(cv, k) && k > 0 ? stuck(cv, k - 1) : loop.y(cv, k)));
    }
  }
  const Study filled =
      recording_study(spells + ", quality = true}\nmissing = {share = 0.01, fill = 'linear'}\n");
  CHECK(recorded(filled, 1, loop).y.allFinite());
}

TEST_CASE("without [record] a loop is recorded as it was measured", "[historian]") {
  const Study study = parse_study(testing::small_study(), "s.toml");
  CHECK_FALSE(study.record.alters());
  CHECK(recorded(study, 5, long_record()).y == long_record().y);
}

TEST_CASE("what makes no record is refused", "[historian]") {
  testing::check_refusals({
      {"", "[record]\noutliers = {size = {constant = 3}}\n", "outliers",
       "record.outliers.share: found nothing; allowed: a number in (0, 0.5]"},
      {"", "[record]\noutliers = {share = 0.1, size = {uniform = [0, 1]}}\n", "outliers",
       "record.outliers.size: found draws from 0 to 1; allowed: a distribution whose every draw is a number "
       "> 0"},
      {"", "[record]\nmissing = {share = 0.7, length = 2}\n", "missing",
       "record.missing.share: found 0.7; allowed: at most 0.667 with gaps of 2 samples: a sample stands "
       "between "
       "two gaps"},
      {"", "[record]\nmissing = {share = 0.1, fill = 'spline'}\n", "missing",
       "record.missing.fill: found 'spline'; allowed: none, hold, linear"},
      {"", "[record]\nmissing = {share = 0.1, length = 0.5}\n", "missing",
       "record.missing.length: found 0.5; allowed: a number >= 1"},
      {"", "[record]\nquantisation = -1\n", "quantisation",
       "record.quantisation: found -1; allowed: a number >= 0"},
      {"", "[record]\ncompression = 'door'\n", "compression",
       "record.compression: found the text 'door'; allowed: a number >= 0"},
  });
  const std::string silent = testing::replaced(testing::small_study(), "noise_standard_deviation = 0.01",
                                               "noise_standard_deviation = {level = 0.01, heat = 0}");
  CHECK_THAT(
      testing::refusal(silent + "[record]\ncompression = 1\n"),
      Catch::Contains("record.compression: found sizes in standard deviations of the noise, which is 0 "
                      "for heat; allowed: simulation.noise_standard_deviation > 0 for every CV"));
  CHECK(testing::refusal(silent + "[record]\nmissing = {share = 0.1}\n") == "accepted");
}

}  // namespace
}  // namespace mpm
