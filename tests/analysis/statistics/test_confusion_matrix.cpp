#include <cmath>

#include <catch2/catch.hpp>

#include "analysis/statistics/confusion_matrix.hpp"
#include "base/error.hpp"

using mpm::ConfusionMatrix;

TEST_CASE("a confusion matrix counts true class by predicted class") {
  ConfusionMatrix matrix(3);
  const int cases[][2] = {{0, 0}, {0, 0}, {0, 1}, {1, 1}, {1, 0}, {1, 1}, {1, 1}};
  for (const auto& verdict : cases) {
    matrix.add(verdict[0], verdict[1]);
  }
  ConfusionMatrix::Counts expected(3, 3);
  expected << 2, 1, 0, 1, 3, 0, 0, 0, 0;
  CHECK(matrix.counts() == expected);
  CHECK(matrix.classes() == 3);
  CHECK(matrix.total() == 7);
  CHECK(matrix.hits() == 5);

  const mpm::Rate accuracy = matrix.accuracy();
  CHECK(accuracy.value == 5.0 / 7.0);
  CHECK(accuracy.interval.lower == mpm::wilson_interval(5, 7).lower);
  const mpm::Rate recall = matrix.recall(1, 0.9);
  CHECK(recall.hits == 3);
  CHECK(recall.total == 4);
  CHECK(recall.interval.upper == mpm::wilson_interval(3, 4, 0.9).upper);
  CHECK(matrix.recall(2).total == 0);
  CHECK(std::isnan(matrix.recall(2).value));
}

TEST_CASE("an empty confusion matrix knows nothing") {
  const ConfusionMatrix matrix(2);
  CHECK(matrix.total() == 0);
  CHECK(std::isnan(matrix.accuracy().value));
  CHECK(matrix.accuracy().interval.lower == 0.0);
  CHECK(matrix.accuracy().interval.upper == 1.0);
}

TEST_CASE("a confusion matrix refuses classes it does not have") {
  using mpm::InputError;
  CHECK_THROWS_AS(ConfusionMatrix(0), InputError);
  ConfusionMatrix matrix(2);
  CHECK_THROWS_WITH(matrix.add(2, 0), "true class: found 2; allowed: 0 to 1");
  CHECK_THROWS_AS(matrix.add(-1, 0), InputError);
  CHECK_THROWS_WITH(matrix.add(0, 2), "predicted class: found 2; allowed: 0 to 1");
  CHECK_THROWS_AS(matrix.add(0, -1), InputError);
  CHECK_THROWS_AS(matrix.recall(2), InputError);
  CHECK_THROWS_AS(matrix.recall(0, 1.5), InputError);
  CHECK_THROWS_AS(matrix.accuracy(0.0), InputError);
  CHECK(matrix.total() == 0);
}
