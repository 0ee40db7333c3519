#include "analysis/methods/ours/any_shape.hpp"

#include <cmath>

namespace mpm {
namespace {

constexpr double kLongestLag = 0.125;  ///< of the record

Eigen::MatrixXd with_lags(const Eigen::RowVectorXd& x) {
  std::vector<double> lags;
  for (double lag = 1.0; lag <= kLongestLag * static_cast<double>(x.size()); lag *= 2.0)
    lags.push_back(lag);
  Eigen::MatrixXd rows(1 + static_cast<Eigen::Index>(lags.size()), x.size());
  rows.row(0) = x;
  for (std::size_t i = 0; i < lags.size(); ++i) {
    const double a = std::exp(-1.0 / lags[i]);
    double state = 0.0;
    for (Eigen::Index k = 0; k < x.size(); ++k)
      rows(1 + static_cast<Eigen::Index>(i), k) = state = a * state + (1.0 - a) * x(k);
  }
  return rows;
}

}  // namespace

std::vector<Eigen::MatrixXd> any_shape_rows(const std::vector<MismatchResponses>& responses,
                                            const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                                            const Eigen::Ref<const Eigen::VectorXd>& initial) {
  constexpr double kTwice = 2.0;  // the response to twice the gain is G0 u
  std::vector<Eigen::MatrixXd> all;
  for (const MismatchResponses& response : responses)
    if (response.prior().parameter == MismatchParameter::gain) {
      const Eigen::Index input = response.prior().channel.mv;
      all.push_back(with_lags(response.at(kTwice, inputs.row(input), initial(input))));
    }
  return all;
}

}  // namespace mpm
