#include "distributions/math_policy.hpp"

#include <boost/math/distributions/normal.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <catch2/catch.hpp>

#include <cmath>
#include <type_traits>

using namespace wingspread;

TEST_CASE("Boost.Math evaluates in double, and raises no exception") {
  using Evaluated = boost::math::policies::evaluation<double, MathPolicy>::type;
  CHECK(std::is_same_v<Evaluated, double>);
  CHECK(std::isnan(boost::math::ibeta(-1.0, 2.0, 0.5, MathPolicy())));
  const boost::math::normal_distribution<double, MathPolicy> normal;
  CHECK(std::isinf(quantile(normal, 0.0)));
}
