#include "solvers/prediction.hpp"

#include <iterator>

namespace mpm {

RowMajorMatrix forced_response(const TransferMatrix& model, Eigen::Index mv_count, double sample_time,
                               int prediction_horizon, const std::vector<int>& starts) {
  const Eigen::Index ny = model.rows();
  const Eigen::Index hp = prediction_horizon;
  const auto positions = static_cast<Eigen::Index>(starts.size());
  RowMajorMatrix response = RowMajorMatrix::Zero(ny * hp, mv_count * positions);

  LinearPlant plant(model, sample_time);
  Eigen::MatrixXd step(ny, hp + 1);  // column l: y(l) for a unit step at sample 0
  for (Eigen::Index j = 0; j < mv_count; ++j) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(model.cols(), j);
    plant.reset(Eigen::VectorXd::Zero(model.cols()));
    for (Eigen::Index l = 0; l <= hp; ++l) {
      step.col(l) = plant.output();
      plant.advance(unit);
    }
    const auto of_step = [&step](Eigen::Index cv, Eigen::Index l) { return l > 0 ? step(cv, l) : 0.0; };
    for (Eigen::Index i = 0; i < positions; ++i) {
      const auto from = starts.begin() + i;
      const bool last = i == positions - 1;
      for (Eigen::Index cv = 0; cv < ny; ++cv)
        for (Eigen::Index l = *from + 1; l <= hp; ++l)
          response(cv * hp + l - 1, i * mv_count + j) =
              of_step(cv, l - *from) - (last ? 0.0 : of_step(cv, l - *std::next(from)));
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
