#include "analysis/statistics/washout.hpp"

#include <cmath>

#include "base/non_finite.hpp"

namespace mpm {

Eigen::MatrixXd gaps_closed(Eigen::MatrixXd signals) {
  for (auto row : signals.rowwise()) {
    Eigen::Index last = -1;
    for (Eigen::Index k = 0; k < row.size(); ++k) {
      if (std::isnan(row(k)))
        continue;
      for (Eigen::Index gap = last + 1; gap < k; ++gap)
        row(gap) = last < 0 ? row(k)
                            : row(last) + (row(k) - row(last)) * static_cast<double>(gap - last) /
                                              static_cast<double>(k - last);
      last = k;
    }
    for (Eigen::Index gap = last + 1; last >= 0 && gap < row.size(); ++gap)
      row(gap) = row(last);
  }
  return signals;
}

Eigen::RowVectorXd washed_out(const Eigen::Ref<const Eigen::RowVectorXd>& y, double a, double start) {
  Eigen::RowVectorXd f = gaps_closed(y);
  double w = start;
  for (Eigen::Index k = 0; k < f.size(); ++k) {
    const double value = f(k);
    f(k) = std::isnan(y(k)) ? kNaN : value - w;
    w = a * w + (1.0 - a) * value;
  }
  return f;
}

Eigen::RowVectorXd washout_undone(const Eigen::Ref<const Eigen::RowVectorXd>& f, double a) {
  Eigen::RowVectorXd y = f;
  double w = 0.0;
  for (double& value : y) {
    value += w;
    w = a * w + (1.0 - a) * value;
  }
  return y;
}

}  // namespace mpm
