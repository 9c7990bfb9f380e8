#include "montecarlo/foundation/statistics/two_sided.hpp"

#include "distributions/continuous_law.hpp"
#include "distributions/math_policy.hpp"

#include <boost/math/distributions/students_t.hpp>

namespace wingspread {

double two_sided_normal(double confidence) {
  const double tail = (1 - confidence) / 2;
  return inverse(Normal{}, {1 - tail, tail});
}

double two_sided_student(long degrees, double confidence) {
  const boost::math::students_t_distribution<double, MathPolicy> student(
      static_cast<double>(degrees));
  return boost::math::quantile(boost::math::complement(student, (1 - confidence) / 2));
}

} // namespace wingspread
