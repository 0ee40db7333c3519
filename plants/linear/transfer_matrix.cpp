#include "plants/linear/transfer_matrix.hpp"

#include <cstddef>

#include <fmt/format.h>

#include "base/error.hpp"

namespace mpm {

TransferMatrix::TransferMatrix(Eigen::Index rows, Eigen::Index cols) : rows_(rows), cols_(cols) {
  if (rows < 0 || cols < 0) {
    throw InputError("size of a transfer matrix", fmt::format("{} x {}", rows, cols), "sizes >= 0");
  }
  channels_.assign(static_cast<std::size_t>(rows * cols), TransferFunction::zero());
}

TransferMatrix::TransferMatrix(std::initializer_list<std::initializer_list<TransferFunction>> rows)
    : rows_(static_cast<Eigen::Index>(rows.size())),
      cols_(rows.size() == 0 ? 0 : static_cast<Eigen::Index>(rows.begin()->size())) {
  for (const auto& row : rows) {
    if (static_cast<Eigen::Index>(row.size()) != cols_) {
      throw InputError("row length of a transfer matrix", fmt::format("{}", row.size()),
                       fmt::format("{}, the length of the first row", cols_));
    }
    channels_.insert(channels_.end(), row.begin(), row.end());
  }
}

std::size_t TransferMatrix::position(Eigen::Index row, Eigen::Index col) const {
  if (row < 0 || row >= rows_ || col < 0 || col >= cols_) {
    throw InputError("channel of a transfer matrix", fmt::format("({}, {})", row, col),
                     fmt::format("row 0 to {}, column 0 to {}", rows_ - 1, cols_ - 1));
  }
  return static_cast<std::size_t>(row * cols_ + col);
}

const TransferFunction& TransferMatrix::operator()(Eigen::Index row, Eigen::Index col) const {
  return channels_[position(row, col)];
}

TransferFunction& TransferMatrix::operator()(Eigen::Index row, Eigen::Index col) {
  return channels_[position(row, col)];
}

Eigen::MatrixXd TransferMatrix::static_gain() const {
  Eigen::MatrixXd gain(rows_, cols_);
  for (Eigen::Index row = 0; row < rows_; ++row) {
    for (Eigen::Index col = 0; col < cols_; ++col) {
      const TransferFunction& channel = (*this)(row, col);
      if (channel.is_integrating()) {
        throw InputError(fmt::format("static gain of channel ({}, {})", row, col),
                         "a pole at s = 0 (integrating channel)", "channels without a pole at s = 0");
      }
      gain(row, col) = channel.static_gain();
    }
  }
  return gain;
}

bool TransferMatrix::is_integrating(Eigen::Index row) const {
  for (Eigen::Index col = 0; col < cols_; ++col)
    if ((*this)(row, col).is_integrating())
      return true;
  return false;
}

bool TransferMatrix::is_integrating() const {
  for (Eigen::Index row = 0; row < rows_; ++row)
    if (is_integrating(row))
      return true;
  return false;
}

Eigen::MatrixXd TransferMatrix::steady_gain() const {
  Eigen::MatrixXd gain(rows_, cols_);
  for (Eigen::Index row = 0; row < rows_; ++row) {
    const bool is_rate = is_integrating(row);
    for (Eigen::Index col = 0; col < cols_; ++col) {
      const TransferFunction& channel = (*this)(row, col);
      gain(row, col) = is_rate ? channel.rate_gain() : channel.static_gain();
    }
  }
  return gain;
}

Eigen::VectorXd TransferMatrix::steady_output(const Eigen::Ref<const Eigen::VectorXd>& input) const {
  Eigen::VectorXd output = Eigen::VectorXd::Zero(rows_);
  for (Eigen::Index row = 0; row < rows_; ++row)
    for (Eigen::Index col = 0; col < cols_; ++col)
      if (const TransferFunction& channel = (*this)(row, col); !channel.is_integrating())
        output(row) += channel.static_gain() * input(col);
  return output;
}

TransferMatrix TransferMatrix::without_step_coefficients() const {
  TransferMatrix rational = *this;
  for (TransferFunction& channel : rational.channels_)
    channel = channel.without_step_coefficients();
  return rational;
}

Eigen::MatrixXcd TransferMatrix::frequency_response(std::complex<double> s) const {
  Eigen::MatrixXcd response(rows_, cols_);
  for (Eigen::Index row = 0; row < rows_; ++row) {
    for (Eigen::Index col = 0; col < cols_; ++col) {
      response(row, col) = (*this)(row, col)(s);
    }
  }
  return response;
}

}  // namespace mpm
