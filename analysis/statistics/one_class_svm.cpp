#include "analysis/statistics/one_class_svm.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

#include <fmt/format.h>
#include <libsvm/svm.h>

#include "base/error.hpp"

namespace mpm {
namespace {

constexpr double kSvmTolerance = 1e-4;  ///< of the optimality conditions
constexpr double kSvmCache = 16.0;      ///< MB of rows of the kernel

/// Keeps libsvm quiet: it would report each training on stdout, through one function for all threads.
bool silence_libsvm() {
  svm_set_print_string_function([](const char*) {});
  return true;
}

void require_svm(const Eigen::Ref<const Eigen::MatrixXd>& points, double nu, double gamma) {
  if (points.cols() == 0 || points.rows() == 0 || !points.allFinite())
    throw InputError("points of a support vector machine",
                     fmt::format("{} x {}, or not finite", points.rows(), points.cols()),
                     "one or more finite points");
  if (!(nu > 0.0 && nu < 1.0))
    throw InputError("nu of a support vector machine", fmt::format("{}", nu), "above 0 and below 1");
  if (!(gamma > 0.0 && std::isfinite(gamma)))
    throw InputError("gamma of a support vector machine", fmt::format("{}", gamma), "above 0");
}

}  // namespace

OneClassSvm::OneClassSvm(const Eigen::Ref<const Eigen::MatrixXd>& points, double nu, double gamma)
    : gamma_(gamma) {
  require_svm(points, nu, gamma);
  const auto n = static_cast<std::size_t>(points.cols()), m = static_cast<std::size_t>(points.rows());
  std::vector<svm_node> nodes(n * (m + 1));
  std::vector<svm_node*> rows(n);
  std::vector<double> labels(n, 1.0);
  for (std::size_t i = 0; i < n; ++i) {
    rows[i] = &nodes[i * (m + 1)];
    for (std::size_t j = 0; j < m; ++j)
      rows[i][j] = {static_cast<int>(j + 1),
                    points(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i))};
    rows[i][m] = {-1, 0.0};
  }
  const svm_problem problem{static_cast<int>(n), labels.data(), rows.data()};
  svm_parameter parameter{};
  parameter.svm_type = ONE_CLASS;
  parameter.kernel_type = RBF;
  parameter.gamma = gamma;
  parameter.nu = nu;
  parameter.cache_size = kSvmCache;
  parameter.eps = kSvmTolerance;
  parameter.shrinking = 1;
  [[maybe_unused]] static const bool silent = silence_libsvm();
  svm_model* trained = svm_train(&problem, &parameter);
  support_.resize(points.rows(), trained->l);
  log_weights_.resize(trained->l);
  for (int i = 0; i < trained->l; ++i) {
    support_.col(i) = points.col(trained->sv_indices[i] - 1);
    log_weights_(i) = std::log(trained->sv_coef[0][i]);
  }
  log_rho_ = std::log(trained->rho[0]);
  svm_free_and_destroy_model(&trained);
}

double OneClassSvm::outsideness(const Eigen::Ref<const Eigen::VectorXd>& x) const {
  if (x.size() != support_.rows())
    throw InputError("point for a support vector machine", fmt::format("{} elements", x.size()),
                     fmt::format("{}", support_.rows()));
  const Eigen::ArrayXd terms =
      log_weights_ - gamma_ * (support_.colwise() - x).colwise().squaredNorm().transpose().array();
  const double largest = terms.maxCoeff();
  return log_rho_ - largest - std::log((terms - largest).exp().sum());
}

}  // namespace mpm
