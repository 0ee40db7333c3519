#include "analysis/statistics/student.hpp"

#include <boost/math/distributions/students_t.hpp>

#include "analysis/statistics/signal_check.hpp"

namespace mpm {

double two_sided_student_quantile(double confidence, std::int64_t freedom) {
  require_confidence(confidence);
  const boost::math::students_t student(static_cast<double>(freedom));
  return boost::math::quantile(boost::math::complement(student, (1.0 - confidence) / 2.0));
}

double student_quantile(double probability, double freedom) {
  return boost::math::quantile(boost::math::students_t(freedom), probability);
}

double student_upper_tail(double t, std::int64_t freedom) {
  const boost::math::students_t student(static_cast<double>(freedom));
  return boost::math::cdf(boost::math::complement(student, t));
}

}  // namespace mpm
