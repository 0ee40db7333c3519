#include "solvers/lanes/lane_program.hpp"

#include <algorithm>

#include "solvers/lanes/kernel_choice.hpp"

namespace mpm {
namespace {

constexpr long kBlocksAtOnce = 8;

Eigen::Index widest(const std::vector<RowBand>& bands) {
  Eigen::Index width = 0;
  for (const RowBand& band : bands)
    width = std::max(width, band.width());
  return width;
}

/// Calls visit(band, first of the listed rows within it, number of these rows) for each band that has listed
/// rows; the list is in increasing order.
template <class Visit>
void visit_bands(const std::vector<RowBand>& bands, const std::vector<int>& list, const Visit& visit) {
  auto next = list.begin();
  for (const RowBand& band : bands) {
    const auto end = std::lower_bound(next, list.end(), static_cast<int>(band.end()));
    if (end != next)
      visit(band, next - list.begin(), end - next);
    next = end;
  }
}

}  // namespace

LaneProgram::LaneProgram(const Eigen::MatrixXd& hessian, const RowMajorMatrix& rows)
    : hessian_(rows.cols(), rows.cols()), bands_(row_bands(rows)), rows_(widest(bands_), rows.rows()) {
  for (Eigen::Index j = 0; j < rows.cols(); ++j)
    std::copy_n(hessian.col(j).data(), rows.cols(), hessian_.column(j));
  for (const RowBand& band : bands_)
    for (Eigen::Index i = 0; i < band.count; ++i)
      for (Eigen::Index c = 0; c < band.width(); ++c)
        rows_(c, band.first + i) = rows(band.first + i, band.columns[static_cast<std::size_t>(c)]);
  if (is_dense())
    dense_.emplace(rows);
  else
    copy_bands();
}

void LaneProgram::copy_bands() {
  for (const RowBand& band : bands_) {
    begin_.push_back(blocks_.size());
    blocks_.resize(blocks_.size() + static_cast<std::size_t>(padded(band.count) * band.width()), 0.0);
    double* blocks = blocks_.data() + begin_.back();
    for (Eigen::Index i = 0; i < band.count; ++i)
      for (Eigen::Index c = 0; c < band.width(); ++c)
        blocks[(i / 8 * band.width() + c) * 8 + i % 8] = rows_(c, band.first + i);
  }
}

void LaneProgram::multiply_rows(const double* x, LaneVector& out) const {
  if (is_dense()) {
    dense_->multiply(x, out);
    return;
  }
  const LaneKernels& kernels = lane_kernels();
  alignas(64) double part[8 * kBlocksAtOnce];
  for (std::size_t b = 0; b < bands_.size(); ++b) {
    const RowBand& band = bands_[b];
    for (Eigen::Index done = 0; done < band.count; done += 8 * kBlocksAtOnce) {
      const Eigen::Index rows = std::min<Eigen::Index>(8 * kBlocksAtOnce, band.count - done);
      kernels.multiply_some(blocks_.data() + begin_[b] + done * band.width(), band.columns.data(),
                            band.width(), padded(rows) / 8, x, part);
      std::copy_n(part, rows, out.data() + band.first + done);
    }
  }
}

void LaneProgram::add_hessian(const double* x, LaneVector& out) const {
  lane_kernels().add_product(hessian_.data(), hessian_.stride(), variable_count(), x, out.data());
}

void LaneProgram::add_rows(const std::vector<int>& list, const double* factor, LaneVector& out) const {
  const LaneKernels& kernels = lane_kernels();
  if (is_dense()) {
    kernels.add_rows(rows_.data(), rows_.stride(), list.data(), static_cast<long>(list.size()), factor,
                     out.data());
    return;
  }
  alignas(64) double sum[kWidestBand];
  visit_bands(bands_, list, [&](const RowBand& band, long first, long count) {
    std::fill_n(sum, rows_.stride(), 0.0);
    for (std::size_t c = 0; c < band.columns.size(); ++c)
      sum[c] = out(band.columns[c]);
    kernels.add_rows(rows_.data(), rows_.stride(), list.data() + first, count, factor, sum);
    for (std::size_t c = 0; c < band.columns.size(); ++c)
      out(band.columns[c]) = sum[c];
  });
}

void LaneProgram::add_outer(const std::vector<int>& list, const std::vector<double>& weight,
                            LaneVector& scratch, LaneMatrix& matrix) const {
  const LaneKernels& kernels = lane_kernels();
  if (is_dense()) {
    kernels.add_outer(rows_.data(), rows_.stride(), list.data(), static_cast<long>(list.size()),
                      weight.data(), scratch.data(), matrix.data(), matrix.stride());
    return;
  }
  const Eigen::Index stride = rows_.stride();
  double* own = scratch.data() + LaneKernels::kOuterRows * stride;  // rows and columns of the band
  visit_bands(bands_, list, [&](const RowBand& band, long first, long count) {
    const int* columns = band.columns.data();
    for (Eigen::Index j = 0; j < band.width(); ++j)
      for (Eigen::Index i = j; i < band.width(); ++i)
        own[j * stride + i] = matrix(columns[i], columns[j]);
    kernels.add_outer(rows_.data(), stride, list.data() + first, count, weight.data() + first, scratch.data(),
                      own, stride);
    for (Eigen::Index j = 0; j < band.width(); ++j)
      for (Eigen::Index i = j; i < band.width(); ++i)
        matrix(columns[i], columns[j]) = own[j * stride + i];
  });
}

Eigen::Index LaneProgram::outer_scratch() const {
  return (LaneKernels::kOuterRows + (is_dense() ? 0 : rows_.stride())) * rows_.stride();
}

}  // namespace mpm
