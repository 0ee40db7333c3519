#include "analysis/identification/lasso_penalty.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <Eigen/QR>
#include <fmt/format.h>

#include "analysis/identification/group_lasso.hpp"
#include "base/error.hpp"

namespace mpm {
namespace {

constexpr int kFolds = 5;
constexpr int kPenalties = 25;
constexpr double kLeastPenalty = 1e-3;

/// The groups of a regression side by side in orthonormal columns, as group_lasso() needs them.
class OrthonormalGroups {
 public:
  OrthonormalGroups(const Eigen::Ref<const Eigen::VectorXd>& r, const std::vector<Eigen::MatrixXd>& groups) {
    std::vector<Eigen::MatrixXd> bases;
    Eigen::Index columns = 0;
    for (const Eigen::MatrixXd& group : groups) {
      // A group without columns has none to decompose.
      decompositions_.emplace_back(group.cols() > 0 ? group : Eigen::MatrixXd::Zero(group.rows(), 1));
      const Eigen::Index rank = decompositions_.back().rank();
      bases.emplace_back(decompositions_.back().householderQ() *
                         Eigen::MatrixXd::Identity(group.rows(), rank));
      sizes_.push_back(rank);
      columns_.push_back(group.cols());
      columns += rank;
    }
    Eigen::MatrixXd Q(r.size(), columns);
    columns = 0;
    for (const Eigen::MatrixXd& base : bases) {
      Q.middleCols(columns, base.cols()) = base;
      columns += base.cols();
    }
    bases_ = std::move(bases);
    gram_ = Q.transpose() * Q;
    product_ = Q.transpose() * r;
  }

  /// The least lambda at which no group enters.
  double largest_penalty() const {
    double largest = 0.0;
    Eigen::Index first = 0;
    for (const Eigen::Index size : sizes_) {
      if (size > 0)
        largest =
            std::max(largest, product_.segment(first, size).norm() / std::sqrt(static_cast<double>(size)));
      first += size;
    }
    return largest;
  }

  std::vector<Eigen::VectorXd> coefficients(double lambda) const {
    Eigen::VectorXd penalty(static_cast<Eigen::Index>(sizes_.size()));
    for (std::size_t j = 0; j < sizes_.size(); ++j)
      penalty(static_cast<Eigen::Index>(j)) = lambda * std::sqrt(static_cast<double>(sizes_[j]));
    const Eigen::VectorXd b = group_lasso(gram_, product_, sizes_, penalty);
    std::vector<Eigen::VectorXd> coefficients;
    Eigen::Index first = 0;
    for (std::size_t j = 0; j < sizes_.size(); ++j) {
      const Eigen::VectorXd fit = bases_[j] * b.segment(first, sizes_[j]);
      coefficients.emplace_back(decompositions_[j].solve(fit).head(columns_[j]));
      first += sizes_[j];
    }
    return coefficients;
  }

 private:
  std::vector<Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>> decompositions_;
  std::vector<Eigen::MatrixXd> bases_;
  std::vector<Eigen::Index> sizes_, columns_;
  Eigen::MatrixXd gram_;
  Eigen::VectorXd product_;
};

/// All rows except `first` ... `last` - 1.
Eigen::MatrixXd rows_outside(const Eigen::Ref<const Eigen::MatrixXd>& all, Eigen::Index first,
                             Eigen::Index last) {
  Eigen::MatrixXd rows(all.rows() - (last - first), all.cols());
  rows << all.topRows(first), all.bottomRows(all.rows() - last);
  return rows;
}

}  // namespace

std::vector<Eigen::VectorXd> penalised_coefficients(const Eigen::Ref<const Eigen::VectorXd>& r,
                                                    const std::vector<Eigen::MatrixXd>& groups,
                                                    double lambda) {
  return OrthonormalGroups(r, groups).coefficients(lambda);
}

double cross_validated_penalty(const Eigen::Ref<const Eigen::VectorXd>& r,
                               const std::vector<Eigen::MatrixXd>& groups) {
  for (const Eigen::MatrixXd& group : groups)
    if (group.rows() != r.size())
      throw InputError("rows of a group of the lasso", fmt::format("{}", group.rows()),
                       fmt::format("{}, as the response has", r.size()));
  const double largest = OrthonormalGroups(r, groups).largest_penalty();
  std::vector<double> squares(kPenalties, 0.0);
  const auto lambda = [largest](int step) {
    return largest * std::pow(kLeastPenalty, step / (kPenalties - 1.0));
  };
  for (Eigen::Index fold = 0; fold < kFolds && largest > 0.0; ++fold) {
    const Eigen::Index first = fold * r.size() / kFolds, last = (fold + 1) * r.size() / kFolds;
    std::vector<Eigen::MatrixXd> learnt;
    for (const Eigen::MatrixXd& group : groups)
      learnt.push_back(rows_outside(group, first, last));
    const OrthonormalGroups of_fold(rows_outside(r, first, last), learnt);
    for (int step = 0; step < kPenalties; ++step) {
      Eigen::VectorXd left = r.segment(first, last - first);
      const std::vector<Eigen::VectorXd> b = of_fold.coefficients(lambda(step));
      for (std::size_t j = 0; j < groups.size(); ++j)
        left -= groups[j].middleRows(first, last - first) * b[j];
      squares[static_cast<std::size_t>(step)] += left.squaredNorm();
    }
  }
  return lambda(static_cast<int>(std::min_element(squares.begin(), squares.end()) - squares.begin()));
}

}  // namespace mpm
