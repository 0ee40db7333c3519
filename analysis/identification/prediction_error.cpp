#include "analysis/identification/prediction_error.hpp"

#include <cstddef>

namespace mpm {
namespace {

/// Fills the columns of a gradient from the left.
class GradientColumns {
 public:
  GradientColumns(Eigen::Index N, Eigen::Index p, StartState start) : gradient_(N, p), start_(start) {}

  /// `count` columns: `signal` delayed by `delay`, `delay` + 1, ...
  void append_shifts(const Eigen::VectorXd& signal, Eigen::Index delay, Eigen::Index count) {
    for (Eigen::Index i = 0; i < count; ++i)
      gradient_.col(next_++) = delayed(signal, delay + i, start_);
  }
  const Eigen::MatrixXd& gradient() const { return gradient_; }

 private:
  Eigen::MatrixXd gradient_;
  StartState start_;
  Eigen::Index next_ = 0;
};

}  // namespace

Eigen::MatrixXd prediction_error_gradient(const PolynomialModel& model,
                                          const Eigen::Ref<const Eigen::VectorXd>& y,
                                          const Eigen::Ref<const Eigen::MatrixXd>& u, StartState start) {
  const Eigen::VectorXd e = prediction_errors(model, y, u, start);
  const ModelOrder order = model.order();
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
  GradientColumns columns(y.size(), order.parameter_count(), start);
  if (order.na > 0)
    columns.append_shifts(filter(model.D, model.C, y, 0, start), 1, order.na);
  for (std::size_t j = 0; j < model.inputs.size(); ++j) {
    const InputPath& path = model.inputs[j];
    const Eigen::VectorXd input = u.row(static_cast<Eigen::Index>(j)).transpose();
    const Eigen::VectorXd filtered = filter(one, path.F, filter(model.D, model.C, input, 0, start), 0, start);
    columns.append_shifts(-filtered, path.delay, order.inputs[j].nb);
    if (order.inputs[j].nf > 0)
      columns.append_shifts(filter(path.B, path.F, filtered, path.delay, start), 1, order.inputs[j].nf);
  }
  if (order.nc > 0)
    columns.append_shifts(-filter(one, model.C, e, 0, start), 1, order.nc);
  // v/C = e/D, without a division by D, which need not be stable.
  if (order.nd > 0) {
    PolynomialModel without_D = model;
    without_D.D = one;
    columns.append_shifts(prediction_errors(without_D, y, u, start), 1, order.nd);
  }
  return columns.gradient();
}

}  // namespace mpm
