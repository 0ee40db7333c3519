#include "solvers/prediction.hpp"

namespace mpm {

RowMajorMatrix forced_response(const TransferMatrix& model, Eigen::Index mv_count, double sample_time,
                               int prediction_horizon, int control_horizon) {
  const Eigen::Index ny = model.rows();
  const Eigen::Index hp = prediction_horizon;
  RowMajorMatrix response = RowMajorMatrix::Zero(ny * hp, mv_count * control_horizon);

  LinearPlant plant(model, sample_time);
  Eigen::MatrixXd step(ny, hp + 1);  // column l: y(l) for a unit step at sample 0
  for (Eigen::Index j = 0; j < mv_count; ++j) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(model.cols(), j);
    plant.reset(Eigen::VectorXd::Zero(model.cols()));
    for (Eigen::Index l = 0; l <= hp; ++l) {
      step.col(l) = plant.output();
      plant.advance(unit);
    }
    for (Eigen::Index cv = 0; cv < ny; ++cv)
      for (Eigen::Index l = 1; l <= hp; ++l)
        for (Eigen::Index i = 0; i < control_horizon && i < l; ++i) {
          const bool last = i == control_horizon - 1;
          const double ended_by_next = last ? 0.0 : step(cv, l - i - 1);
          response(cv * hp + l - 1, i * mv_count + j) = step(cv, l - i) - ended_by_next;
        }
  }
  return response;
}

void free_response(const LinearPlant& model, const Eigen::Ref<const Eigen::VectorXd>& held_input,
                   LinearPlant& scratch, Eigen::Ref<Eigen::MatrixXd> response) {
  scratch = model;
  for (Eigen::Index l = 0; l < response.cols(); ++l) {
    scratch.advance(held_input);
    response.col(l) = scratch.output();
  }
}

}  // namespace mpm
