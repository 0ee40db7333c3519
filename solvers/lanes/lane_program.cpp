#include "solvers/lanes/lane_program.hpp"

#include <algorithm>

#include "solvers/lanes/kernel_choice.hpp"

namespace mpm {

LaneProgram::LaneProgram(const Eigen::MatrixXd& hessian, const RowBlocks::Rows& rows)
    : hessian_(rows.cols(), rows.cols()), rows_(rows.cols(), rows.rows()), blocks_(rows) {
  for (Eigen::Index j = 0; j < rows.cols(); ++j)
    std::copy_n(hessian.col(j).data(), rows.cols(), hessian_.column(j));
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    std::copy_n(rows.row(i).data(), rows.cols(), rows_.column(i));
}

void LaneProgram::multiply_rows(const double* x, LaneVector& out) const {
  blocks_.multiply(x, out);
}

void LaneProgram::add_hessian(const double* x, LaneVector& out) const {
  lane_kernels().add_product(hessian_.data(), hessian_.stride(), variable_count(), x, out.data());
}

void LaneProgram::add_rows(const std::vector<int>& list, const double* factor, LaneVector& out) const {
  lane_kernels().add_rows(rows_.data(), rows_.stride(), list.data(), static_cast<long>(list.size()), factor,
                          out.data());
}

void LaneProgram::add_outer(const std::vector<int>& list, const std::vector<double>& weight,
                            LaneVector& scratch, LaneMatrix& matrix) const {
  lane_kernels().add_outer(rows_.data(), rows_.stride(), list.data(), static_cast<long>(list.size()),
                           weight.data(), scratch.data(), matrix.data(), matrix.stride());
}

Eigen::Index LaneProgram::outer_scratch() const {
  return LaneKernels::kOuterRows * rows_.stride();
}

}  // namespace mpm
