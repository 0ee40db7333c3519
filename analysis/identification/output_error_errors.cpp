#include "analysis/identification/output_error_errors.hpp"

#include <cmath>

#include "analysis/statistics/discrete_filter.hpp"
#include "base/non_finite.hpp"

namespace mpm {

bool roots_within(const Eigen::MatrixXd& F, double radius) {
  for (Eigen::Index j = 0; j < F.cols(); ++j)
    if (!has_roots_within(F.col(j), radius))
      return false;
  return true;
}

OutputErrors::OutputErrors(const Eigen::Ref<const Eigen::MatrixXd>& u,
                           const Eigen::Ref<const Eigen::VectorXd>& y, Eigen::Index delay, Eigen::Index rows)
    : nu_(u.rows()),
      delay_(delay),
      // The unused last signal of twice_ and path_ has the place of e.
      twice_(2 * nu_ + 1, u.cols(), rows),
      path_(2 * nu_ + 1, u.cols(), rows),
      gradient_(2 * nu_ + 1, u.cols(), rows),
      y_(y),
      errors_(y.size()) {
  for (Eigen::Index j = 0; j < nu_; ++j)
    twice_[j] = twice_[nu_ + j] = u.row(j).transpose();
}

double OutputErrors::cost(const OutputErrorCoefficients& model) {
  const Eigen::Index nb = model.B.rows(), nf = model.F.rows() - 1, rows = model.rows(delay_);
  columns_.clear();
  for (Eigen::Index j = 0; j < nu_; ++j) {
    columns_.push_back({j, delay_, nb});
    columns_.push_back({nu_ + j, 1, nf});
  }
  const auto zero = [&] { return Eigen::MatrixXd(Eigen::MatrixXd::Zero(rows, 2 * nu_ + 1)); };
  Eigen::MatrixXd first = zero(), numerators = zero(), second = zero();
  first.topLeftCorner(nf + 1, nu_) = model.F;
  first.block(0, nu_, nf + 1, nu_) = model.F;
  numerators.row(0).head(nu_).setConstant(-1.0);
  numerators.block(delay_, nu_, nb, nu_) = model.B;
  second.block(0, nu_, nf + 1, nu_) = model.F;
  filter_paths(first, numerators, &second, twice_, path_, gradient_);
  errors_ = y_;
  for (Eigen::Index group = 0; group < path_.groups(); ++group) {
    const Eigen::Index begin = std::max<Eigen::Index>(0, nu_ - 8 * group);
    const Eigen::Index end = std::min<Eigen::Index>(8, 2 * nu_ - 8 * group);
    const double* path = path_.at(group, 0);
    for (Eigen::Index k = 0; k < errors_.size(); ++k, path += 8) {
      double error = errors_(k);
      for (Eigen::Index lane = begin; lane < end; ++lane)
        error -= path[lane];
      errors_(k) = error;
    }
  }
  gradient_[2 * nu_] = errors_;
  const double sum = errors_.squaredNorm();
  return std::isfinite(sum) ? 0.5 * sum : kInfinity;
}

void OutputErrors::products(Eigen::MatrixXd& JJ, Eigen::VectorXd& Je) {
  Eigen::Index largest = 0;
  for (const LaggedColumns& group : columns_)
    largest = std::max(largest, group.lag + group.count - 1);
  sums_.compute(gradient_, 2 * nu_, largest, 0);
  JJ = sums_.products(columns_);
  Je = sums_.products_with(columns_, 2 * nu_);
}

}  // namespace mpm
