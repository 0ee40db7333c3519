#include "analysis/identification/group_lasso.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {
namespace {

/// How far the columns of a group may be from orthonormal: rounding of the products of some thousand samples.
constexpr double kOrthonormal = 1e-8;

void require_orthonormal(const Eigen::Ref<const Eigen::MatrixXd>& gram,
                         const std::vector<Eigen::Index>& sizes) {
  Eigen::Index first = 0;
  for (const Eigen::Index size : sizes) {
    const Eigen::MatrixXd block = gram.block(first, first, size, size);
    if (size > 0 && !(block - Eigen::MatrixXd::Identity(size, size)).isZero(kOrthonormal))
      throw InputError("columns of a group of the lasso", "products other than those of orthonormal columns",
                       "orthonormal columns");
    first += size;
  }
}

void require_lasso(const Eigen::Ref<const Eigen::MatrixXd>& gram,
                   const Eigen::Ref<const Eigen::VectorXd>& product, const std::vector<Eigen::Index>& sizes,
                   const Eigen::Ref<const Eigen::VectorXd>& penalty) {
  const Eigen::Index columns = std::accumulate(sizes.begin(), sizes.end(), Eigen::Index{0});
  if (gram.rows() != columns || gram.cols() != columns || product.size() != columns)
    throw InputError("products of the lasso",
                     fmt::format("{} x {} and {}", gram.rows(), gram.cols(), product.size()),
                     fmt::format("{} columns, as its groups have", columns));
  if (penalty.size() != static_cast<Eigen::Index>(sizes.size()))
    throw InputError("penalties of the lasso", fmt::format("{}", penalty.size()),
                     fmt::format("{}, one a group", sizes.size()));
  if (!(penalty.array() >= 0.0).all())
    throw InputError("penalties of the lasso", "one below 0 or not a number", "0 or more");
  require_orthonormal(gram, sizes);
}

}  // namespace

Eigen::VectorXd group_lasso(const Eigen::Ref<const Eigen::MatrixXd>& gram,
                            const Eigen::Ref<const Eigen::VectorXd>& product,
                            const std::vector<Eigen::Index>& sizes,
                            const Eigen::Ref<const Eigen::VectorXd>& penalty,
                            const GroupLassoOptions& options) {
  require_lasso(gram, product, sizes, penalty);
  const double small = options.tolerance * product.norm();
  Eigen::VectorXd b = Eigen::VectorXd::Zero(product.size());
  for (int sweep = 0; sweep < options.most_sweeps; ++sweep) {
    double moved = 0.0;
    Eigen::Index first = 0;
    for (std::size_t j = 0; j < sizes.size(); ++j) {
      const Eigen::Index size = sizes[j];
      const Eigen::VectorXd old = b.segment(first, size);
      const Eigen::VectorXd g = product.segment(first, size) - gram.middleRows(first, size) * b + old;
      const double length = g.norm();
      const double lambda = penalty(static_cast<Eigen::Index>(j));
      b.segment(first, size) = length > lambda ? Eigen::VectorXd((1.0 - lambda / length) * g)
                                               : Eigen::VectorXd(Eigen::VectorXd::Zero(size));
      moved = std::max(moved, (b.segment(first, size) - old).lpNorm<Eigen::Infinity>());
      first += size;
    }
    if (moved <= small)
      break;
  }
  return b;
}

}  // namespace mpm
