#include "analysis/sensitivity/nominal_output.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/non_finite.hpp"
#include "base/row_major.hpp"
#include "plants/linear/linear_plant.hpp"

namespace mpm {
namespace {

/// Adds to `output` the response of a system with step response `step` (values 1..L samples after the step,
/// the last one held) to `input`, from rest: output(k) += sum_l (step(l) - step(l-1)) input(k-l).
void add_response(const Eigen::Ref<const Eigen::RowVectorXd>& step,
                  const Eigen::Ref<const Eigen::RowVectorXd>& input, Eigen::Ref<Eigen::RowVectorXd> output) {
  double previous = 0.0;
  for (Eigen::Index l = 1; l <= std::min(step.size(), input.size() - 1); ++l) {
    const double impulse = step(l - 1) - previous;
    previous = step(l - 1);
    if (impulse != 0.0)
      output.tail(input.size() - l) += impulse * input.head(input.size() - l);
  }
}

}  // namespace

Eigen::MatrixXd simulated_output(const TransferMatrix& model, double sample_time,
                                 const Eigen::Ref<const Eigen::VectorXd>& initial_u,
                                 const Eigen::Ref<const Eigen::MatrixXd>& u,
                                 const Eigen::Ref<const Eigen::MatrixXd>& d) {
  Eigen::VectorXd input = Eigen::VectorXd::Zero(model.cols());
  input.head(initial_u.size()) = initial_u;
  LinearPlant plant(model, sample_time);
  plant.reset(input);
  Eigen::MatrixXd y_sim(model.rows(), u.cols());
  for (Eigen::Index k = 0; k < u.cols(); ++k) {
    y_sim.col(k) = plant.output();
    input << u.col(k), d.col(k);
    plant.advance(input);
  }
  return y_sim;
}

Eigen::RowVectorXd diagonal_nominal_output(const Eigen::Ref<const Eigen::RowVectorXd>& step,
                                           const Eigen::Ref<const Eigen::RowVectorXd>& y,
                                           const Eigen::Ref<const Eigen::RowVectorXd>& y_sim) {
  if (y.size() != y_sim.size())
    throw InputError("y and y_sim", fmt::format("{} and {} samples", y.size(), y_sim.size()),
                     "equal lengths");
  // y + S0 (y_sim - y) = y_sim + T0 (y - y_sim)
  Eigen::RowVectorXd y0_diag = y_sim;
  add_response(step, y - y_sim, y0_diag);
  return y0_diag;
}

NominalOutputs nominal_outputs(const NominalSensitivity& sensitivity,
                               const Eigen::Ref<const Eigen::MatrixXd>& y,
                               const Eigen::Ref<const Eigen::MatrixXd>& y_sim) {
  if (y.rows() != sensitivity.cv_count || y_sim.rows() != y.rows() || y_sim.cols() != y.cols())
    throw InputError("y and y_sim",
                     fmt::format("{} x {} and {} x {}", y.rows(), y.cols(), y_sim.rows(), y_sim.cols()),
                     fmt::format("{} rows and equal shapes", sensitivity.cv_count));
  // y + S0 (y_sim - y) = y_sim + T0 (y - y_sim): only the columns of T0 for active CVs are not zero. The rows
  // are made contiguous once, because the convolution runs along time.
  const RowMajorMatrix error = y - y_sim;
  if (!sensitivity.is_known) {
    const Eigen::MatrixXd none = Eigen::MatrixXd::Constant(y.rows(), y.cols(), kNaN);
    return {y_sim, none, none};
  }
  RowMajorMatrix y0 = y_sim;
  RowMajorMatrix y0_diag = y_sim;
  for (std::size_t a = 0; a < sensitivity.active.size(); ++a) {
    const Eigen::Index j = sensitivity.active[a].cv;
    const RowMajorMatrix step = sensitivity.step_response[a];
    for (Eigen::Index i = 0; i < y.rows(); ++i)
      add_response(step.row(i), error.row(j), y0.row(i));
    y0_diag.row(j) =
        diagonal_nominal_output(step.row(j), RowMajorMatrix(y.row(j)), RowMajorMatrix(y_sim.row(j)));
  }
  return {y_sim, y0, y0_diag};
}

}  // namespace mpm
