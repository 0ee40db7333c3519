#include "analysis/statistics/chi_squared.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/special_functions/gamma.hpp>

namespace mpm {

double chi_squared_quantile(double probability, double freedom) {
  return boost::math::quantile(boost::math::chi_squared(freedom), probability);
}

double chi_squared_upper_quantile(double probability, double freedom) {
  return boost::math::quantile(boost::math::complement(boost::math::chi_squared(freedom), probability));
}

double chi_squared_upper_tail(double x, double freedom) {
  return boost::math::gamma_q(freedom / 2.0, x / 2.0);
}

}  // namespace mpm
