#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "base/non_finite.hpp"
#include "plants/analyser.hpp"

namespace mpm {
namespace {

/// What an analyser shows of a signal, sample by sample, and beside it a CV that is always measured.
Eigen::MatrixXd shown_of(const AnalyserTiming& timing, const Eigen::RowVectorXd& signal, double at_rest) {
  AnalyserHold hold({timing, {}});
  hold.reset(Eigen::Vector2d(at_rest, 0.0));
  Eigen::MatrixXd shown(2, signal.size());
  for (Eigen::Index k = 0; k < signal.size(); ++k) {
    Eigen::VectorXd y = Eigen::Vector2d::Constant(signal(k));
    hold.pass(y);
    shown.col(k) = y;
  }
  return shown;
}

}  // namespace

TEST_CASE("analyser: what is shown is the last sample of the stream that has been analysed", "[analyser]") {
  constexpr Eigen::Index kSamples = 40;
  const Eigen::RowVectorXd signal = Eigen::RowVectorXd::LinSpaced(kSamples, 1.0, 40.0);
  for (int period = 1; period <= 5; ++period)
    for (int delay = 0; delay <= 7; ++delay)  // an analysis may take longer than a period
      for (int first = 0; first < period; ++first) {
        INFO("period " << period << ", delay " << delay << ", first " << first);
        const Eigen::MatrixXd shown = shown_of({period, delay, first}, signal, -1.0);
        CHECK(shown.row(1) == signal);
        for (Eigen::Index k = 0; k < kSamples; ++k) {
          double expected = -1.0;
          for (Eigen::Index taken = first; taken + delay <= k; taken += period)
            expected = signal(taken);
          CHECK(shown(0, k) == expected);
        }
      }
}

TEST_CASE("analyser: of what is shown the analyses are found at the samples at which they were taken",
          "[analyser]") {
  const Eigen::RowVectorXd signal = Eigen::RowVectorXd::LinSpaced(50, 0.0, 7.0).array().sin();
  const AnalyserTiming timing{4, 6, 3};
  const Eigen::RowVectorXd shown = shown_of(timing, signal, 0.5).row(0);
  const AnalyserTiming found = with_first_of({4, 6, 0}, shown);
  CHECK(found == timing);
  const Eigen::RowVectorXd at = analyses(found, shown);
  for (Eigen::Index k = 0; k < signal.size(); ++k) {
    const bool is_known = k % 4 == 3 && k + 6 < signal.size();
    CHECK(std::isnan(at(k)) == !is_known);
    if (is_known)
      CHECK(at(k) == signal(k));
  }
}

TEST_CASE("analyser: gaps of a record do not hide when analyses come", "[analyser]") {
  const Eigen::RowVectorXd signal = Eigen::RowVectorXd::LinSpaced(60, 0.0, 9.0).array().cos();
  Eigen::RowVectorXd shown = shown_of({5, 2, 1}, signal, 0.5).row(0);
  shown.segment(20, 13).setConstant(kNaN);
  CHECK(with_first_of({5, 2, 0}, shown).first == 1);
}

TEST_CASE("analyser: what is known in the end stands where it was measured", "[analyser]") {
  Eigen::MatrixXd signals(3, 40);
  signals.row(0).setLinSpaced(0.0, 5.0);
  signals.row(1) = signals.row(0).array().sin();
  signals.row(2) = signals.row(0).array().cos();
  const std::vector<AnalyserTiming> timings{{}, {1, 3, 0}, {5, 2, 4}};
  const Eigen::Vector3d rest(7.0, 8.0, 9.0);
  const Eigen::MatrixXd shown = as_shown(timings, signals, rest);
  CHECK(shown.row(0) == signals.row(0));
  CHECK((shown.row(1).head(3).array() == 8.0).all());
  CHECK(shown.row(1).tail(37) == signals.row(1).head(37));
  CHECK((shown.row(2).head(6).array() == 9.0).all());
  CHECK(shown(2, 10) == signals(2, 4));
  CHECK(shown(2, 11) == signals(2, 9));

  const Eigen::MatrixXd known = as_taken(timings, shown);
  CHECK(known.row(0) == signals.row(0));
  CHECK(known.row(1).head(37) == signals.row(1).head(37));
  CHECK((known.row(1).tail(3).array() == signals(1, 36)).all());
  CHECK((known.row(2).head(4).array() == 9.0).all());
  for (Eigen::Index k = 4; k < 40; ++k)  // the analysis of sample 39 would be shown at 41
    CHECK(known(2, k) == signals(2, std::min<Eigen::Index>((k - 4) / 5 * 5 + 4, 34)));
  CHECK(as_shown(timings, known, rest) == shown);
  CHECK(as_taken_in_record({{}, {1, 3, 0}, {5, 2, 0}}, shown) == known);
}

TEST_CASE("analyser: a second start shows what was measured then", "[analyser]") {
  AnalyserHold hold({AnalyserTiming{3, 1, 0}});
  Eigen::VectorXd y = Eigen::VectorXd::Constant(1, 2.0);
  hold.reset(y);
  for (int k = 0; k < 5; ++k) {
    y(0) = 7.0;
    hold.pass(y);
  }
  CHECK(y(0) == 7.0);
  hold.reset(Eigen::VectorXd::Constant(1, 4.0));
  y(0) = 9.0;
  hold.pass(y);
  CHECK(y(0) == 4.0);
  hold.pass(y);
  CHECK(y(0) == 9.0);
}

}  // namespace mpm
