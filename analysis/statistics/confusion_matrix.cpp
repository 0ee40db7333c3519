#include "analysis/statistics/confusion_matrix.hpp"

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {

ConfusionMatrix::ConfusionMatrix(Eigen::Index classes) {
  if (classes < 1) {
    throw InputError("number of classes", fmt::format("{}", classes), "1 or more");
  }
  counts_ = Counts::Zero(classes, classes);
}

void ConfusionMatrix::require_class(const char* quantity, Eigen::Index found) const {
  if (found < 0 || found >= classes()) {
    throw InputError(quantity, fmt::format("{}", found), fmt::format("0 to {}", classes() - 1));
  }
}

void ConfusionMatrix::add(Eigen::Index true_class, Eigen::Index predicted_class) {
  require_class("true class", true_class);
  require_class("predicted class", predicted_class);
  ++counts_(true_class, predicted_class);
}

Rate ConfusionMatrix::accuracy(double confidence) const {
  return rate(hits(), total(), confidence);
}

Rate ConfusionMatrix::recall(Eigen::Index true_class, double confidence) const {
  require_class("true class", true_class);
  return rate(counts_(true_class, true_class), counts_.row(true_class).sum(), confidence);
}

}  // namespace mpm
