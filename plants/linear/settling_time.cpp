#include "plants/linear/settling_time.hpp"

namespace mpm {

double sum_of_time_constants(const TransferFunction& channel) {
  // (a_n + a_(n-1) s + ...)/a_n begins 1 + T s
  const Eigen::VectorXd a = channel.denominator().head(channel.order() + (channel.is_integrating() ? 0 : 1));
  return a.size() == 1 ? 0.0 : a(a.size() - 2) / a(a.size() - 1);
}

double settling_time(const TransferFunction& channel) {
  return channel.is_zero() ? 0.0 : channel.dead_time() + 3.0 * sum_of_time_constants(channel);
}

}  // namespace mpm
