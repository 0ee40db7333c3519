#include "analysis/methods/ours/whitened_errors.hpp"

namespace mpm {

WhitenedErrors::WhitenedErrors(const BaseNoise& noise, const Eigen::MatrixXd& series, double noise_freedom)
    : models_(base_models(noise, false).models),
      e_(series.row(0)),
      likelihood_{noise_freedom, static_cast<double>((!e_.array().isNaN()).count())} {
  const Eigen::MatrixXd white = whitened(models_, series, log_determinant_);
  white_ = white.row(0);
  Z_ = white.bottomRows(white.rows() - 1);
  inner_.compute(Z_ * Z_.transpose() + Eigen::MatrixXd::Identity(Z_.rows(), Z_.rows()));
  log_determinant_ += 2.0 * inner_.matrixLLT().diagonal().array().log().sum();
}

Eigen::MatrixXd WhitenedErrors::white_of(const Eigen::Ref<const Eigen::MatrixXd>& h) const {
  Eigen::MatrixXd all(1 + h.rows(), e_.size());
  all << e_, h;
  double unused = 0.0;
  return whitened(models_, all, unused).bottomRows(h.rows());
}

double WhitenedErrors::product_of(const Eigen::RowVectorXd& a, const Eigen::RowVectorXd& b) const {
  const Eigen::VectorXd with_Z = Z_ * b.transpose();
  return a.dot(b) - (Z_ * a.transpose()).dot(inner_.solve(with_Z));
}

double WhitenedErrors::log_likelihood(const Eigen::Ref<const Eigen::RowVectorXd>& h) const {
  const Eigen::RowVectorXd left = white_ - white_of(h);
  return likelihood_(log_determinant_, product_of(left, left));
}

WhitenedErrors::Amplitude WhitenedErrors::amplitude(const Eigen::Ref<const Eigen::RowVectorXd>& h) const {
  const Eigen::RowVectorXd white = white_of(h);
  return {product_of(white_, white), product_of(white, white)};
}

Eigen::MatrixXd WhitenedErrors::gains(const Eigen::Ref<const Eigen::MatrixXd>& h) const {
  const Eigen::ArrayXXd white = white_of(h).array();
  return 2.0 * (white.rowwise() * white_.array()) - white.square();
}

}  // namespace mpm
