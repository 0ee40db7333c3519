#include "analysis/identification/kalman_whitening.hpp"

#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

#include "analysis/identification/sum_of_outer_products.hpp"

namespace mpm {
namespace {

/// Variances and gains of the filter, the same for every series: they depend on the models and on which
/// samples are observed. With x^ the state given the samples up to k - 1 and P its variance, the innovation
/// of an observed sample after an observed one is
///
///   z(k) - phi z(k-1) - (a - phi) x^(k-1),   S = (a - phi)^2 P + b^2 + 1 - phi^2,
///
/// and that of the first sample, or of a sample after a gap, is z(k) - a x^(k-1), S = a^2 P + b^2 + 1. The
/// next state is x^(k) = a x^(k-1) + K innovation.
class Gains {
 public:
  explicit Gains(const NoiseModels& models)
      : models_(models),
        difference_(models.a - models.phi),
        squared_a_(models.a.square()),
        squared_b_(models.b.square()),
        P_(Eigen::ArrayXd::Zero(models.count())),
        determinant_(Eigen::ArrayXd::Ones(models.count())),
        log_determinant_(Eigen::ArrayXd::Zero(models.count())) {}

  /// Goes on to an observed sample. Returns whether the sample before it counts in the innovation.
  bool observe() {
    const bool chained = models_.phi != 0.0 && previous_;
    if (!(settled_ && previous_))
      renew(chained);
    determinant_ *= S;
    if (++factors_ == kFactors)
      fold();
    previous_ = true;
    first_ = false;
    return chained;
  }

  /// Goes on over a missing sample.
  void skip() {
    P_ = predicted();
    previous_ = settled_ = first_ = false;
  }

  /// The factor of the state in the prediction of a sample, which the innovation subtracts.
  const Eigen::ArrayXd& state_factor(bool chained) const { return chained ? difference_ : models_.a; }

  Eigen::ArrayXd log_determinant() {
    fold();
    return log_determinant_;
  }

  Eigen::ArrayXd S, inverse_S, root_inverse_S, K;

 private:
  static constexpr int kFactors = 16;  // so many S <= 1e19 are multiplied before the logarithm is taken

  Eigen::ArrayXd predicted() const {
    if (first_ && !models_.starts_from_rest)
      return squared_b_ / (1.0 - squared_a_);
    return first_ ? Eigen::ArrayXd::Zero(models_.count()).eval() : (squared_a_ * P_ + squared_b_).eval();
  }

  void renew(bool chained) {
    const Eigen::ArrayXd ahead = predicted();
    Eigen::ArrayXd covariance = ahead;
    if (chained) {
      covariance = models_.a * difference_ * P_ + squared_b_;
      S = difference_.square() * P_ + squared_b_ + (1.0 - models_.phi * models_.phi);
    } else {
      S = ahead + 1.0;
    }
    inverse_S = S.inverse();
    root_inverse_S = inverse_S.sqrt();
    K = covariance * inverse_S;
    const Eigen::ArrayXd next = ahead - K * covariance;
    settled_ = previous_ && ((next - P_).abs() <= 1e-13 * (1.0 + next)).all();
    P_ = next;
  }

  void fold() {
    log_determinant_ += determinant_.log();
    determinant_.setOnes();
    factors_ = 0;
  }

  const NoiseModels& models_;
  Eigen::ArrayXd difference_, squared_a_, squared_b_, P_, determinant_, log_determinant_;
  bool previous_ = false, settled_ = false, first_ = true;
  int factors_ = 0;
};

/// The products of one series, with all models side by side.
WhitenedProducts squares_abreast(const NoiseModels& models,
                                 const Eigen::Ref<const Eigen::RowVectorXd, 0, Eigen::InnerStride<>>& z) {
  Gains gains(models);
  Eigen::ArrayXd state = Eigen::ArrayXd::Zero(models.count()), squares = state, innovation(models.count());
  for (Eigen::Index k = 0; k < z.size(); ++k) {
    if (std::isnan(z(k))) {
      state *= models.a;
      gains.skip();
      continue;
    }
    const bool chained = gains.observe();
    innovation = (chained ? z(k) - models.phi * z(k - 1) : z(k)) - gains.state_factor(chained) * state;
    state = models.a * state + gains.K * innovation;
    squares += innovation * gains.inverse_S * innovation;
  }
  return {gains.log_determinant(), {squares}};
}

/// The products of several series, model by model: all series side by side, and their products in blocks of
/// samples.
WhitenedProducts products_of_rows(const NoiseModels& models,
                                  const Eigen::Ref<const Eigen::MatrixXd>& series) {
  const Eigen::Index p = series.rows();
  Gains gains(models);
  std::vector<SumOfOuterProducts> sums(static_cast<std::size_t>(models.count()), SumOfOuterProducts(p));
  Eigen::MatrixXd state = Eigen::MatrixXd::Zero(p, models.count());
  Eigen::VectorXd z(p), innovation(p);
  for (Eigen::Index k = 0; k < series.cols(); ++k) {
    if (std::isnan(series(0, k))) {
      state *= models.a.matrix().asDiagonal();
      gains.skip();
      continue;
    }
    const bool chained = gains.observe();
    z = series.col(k);
    if (chained)
      z -= models.phi * series.col(k - 1);
    for (Eigen::Index model = 0; model < models.count(); ++model) {
      innovation = z - gains.state_factor(chained)(model) * state.col(model);
      state.col(model) = models.a(model) * state.col(model) + gains.K(model) * innovation;
      sums[static_cast<std::size_t>(model)].next() = gains.root_inverse_S(model) * innovation;
    }
  }
  WhitenedProducts all{gains.log_determinant(), {}};
  all.products.assign(static_cast<std::size_t>(p * (p + 1) / 2), Eigen::ArrayXd(models.count()));
  for (Eigen::Index model = 0; model < models.count(); ++model) {
    const Eigen::MatrixXd& lower = sums[static_cast<std::size_t>(model)].lower();
    std::size_t pair = 0;
    for (Eigen::Index i = 0; i < p; ++i)
      for (Eigen::Index j = 0; j <= i; ++j)
        all.products[pair++](model) = lower(i, j);
  }
  return all;
}

}  // namespace

const Eigen::ArrayXd& WhitenedProducts::of(Eigen::Index i, Eigen::Index j) const {
  if (i < j)
    std::swap(i, j);
  return products[static_cast<std::size_t>(i * (i + 1) / 2 + j)];
}

WhitenedProducts whitened_products(const NoiseModels& models,
                                   const Eigen::Ref<const Eigen::MatrixXd>& series) {
  return series.rows() == 1 ? squares_abreast(models, series.row(0)) : products_of_rows(models, series);
}

WhitenedProducts marginalised(const WhitenedProducts& sums, Eigen::Index rows, Eigen::Index q) {
  WhitenedProducts left{sums.log_determinant,
                        {sums.products.begin(), sums.products.begin() + rows * (rows + 1) / 2}};
  if (q == 0)
    return left;
  Eigen::MatrixXd inner(q, q), with_rows(q, rows);
  for (Eigen::Index model = 0; model < sums.log_determinant.size(); ++model) {
    for (Eigen::Index i = 0; i < q; ++i) {
      for (Eigen::Index j = 0; j <= i; ++j)
        inner(i, j) = sums.of(rows + i, rows + j)(model) + (i == j ? 1.0 : 0.0);
      for (Eigen::Index j = 0; j < rows; ++j)
        with_rows(i, j) = sums.of(rows + i, j)(model);
    }
    const Eigen::LLT<Eigen::MatrixXd> factor(inner);
    factor.matrixL().solveInPlace(with_rows);
    left.log_determinant(model) += 2.0 * factor.matrixLLT().diagonal().array().log().sum();
    std::size_t pair = 0;
    for (Eigen::Index i = 0; i < rows; ++i)
      for (Eigen::Index j = 0; j <= i; ++j)
        left.products[pair++](model) -= with_rows.col(i).dot(with_rows.col(j));
  }
  return left;
}

Eigen::MatrixXd whitened(const NoiseModels& models, const Eigen::Ref<const Eigen::MatrixXd>& series,
                         double& log_determinant) {
  const NoiseModels one{models.a.head(1), models.b.head(1), models.phi, models.starts_from_rest};
  Gains gains(one);
  const double a = one.a(0);
  Eigen::MatrixXd white = Eigen::MatrixXd::Zero(series.rows(), series.cols());
  Eigen::VectorXd state = Eigen::VectorXd::Zero(series.rows());
  Eigen::VectorXd innovation(series.rows());
  for (Eigen::Index k = 0; k < series.cols(); ++k) {
    if (std::isnan(series(0, k))) {
      state *= a;
      gains.skip();
      continue;
    }
    const bool chained = gains.observe();
    innovation = series.col(k) - gains.state_factor(chained)(0) * state;
    if (chained)
      innovation -= models.phi * series.col(k - 1);
    state = a * state + gains.K(0) * innovation;
    white.col(k) = gains.root_inverse_S(0) * innovation;
  }
  log_determinant = gains.log_determinant()(0);
  return white;
}

}  // namespace mpm
