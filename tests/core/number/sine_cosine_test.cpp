#include "core/number/sine_cosine.hpp"
#include "tests/support/random_scenes.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <catch2/catch.hpp>

using namespace wingspread;
using Reference =
    boost::multiprecision::cpp_bin_float_100; // quad itself loses digits beside multiples of π/2

namespace {

/// Error of x in units in the last place of the exact value.
double ulps(double x, const Reference& exact) {
  const double nearest = static_cast<double>(exact);
  const double ulp = std::nextafter(std::abs(nearest), INFINITY) - std::abs(nearest);
  return std::abs(static_cast<double>(Reference((Reference(x) - exact) / ulp)));
}

double worst_ulps(double lower, double upper, int count) {
  oracle::Draws draws(42);
  double worst = 0;
  for (int k = 0; k < count; ++k) {
    const double x = draws.uniform(lower, upper);
    const SineCosine<double> got = sine_cosine(x);
    worst =
        std::max({worst, ulps(got.sine, sin(Reference(x))), ulps(got.cosine, cos(Reference(x)))});
  }
  return worst;
}

} // namespace

TEST_CASE("sine and cosine are right to 2 ulp over the angles a wing can take, and far beyond") {
  CHECK(worst_ulps(-0.8, 0.8, 30'000) < 2);
  CHECK(worst_ulps(-7, 7, 30'000) < 2);
  CHECK(worst_ulps(-1e3, 1e3, 20'000) < 2);
  CHECK(worst_ulps(-1e6, 1e6, 20'000) < 2);
}

TEST_CASE("sine and cosine keep their relative accuracy beside multiples of a right angle") {
  for (int quarter = -40; quarter <= 40; ++quarter)
    for (int step = -3; step <= 3; ++step) {
      double x = quarter * 1.5707963267948966;
      for (int k = 0; k < std::abs(step); ++k) x = std::nextafter(x, step > 0 ? 1e9 : -1e9);
      const SineCosine<double> got = sine_cosine(x);
      CAPTURE(quarter, step);
      CHECK(ulps(got.sine, sin(Reference(x))) < 2);
      CHECK(ulps(got.cosine, cos(Reference(x))) < 2);
    }
}

TEST_CASE("sine and cosine of NaN are NaN") {
  CHECK(std::isnan(sine_cosine(std::nan("")).sine));
  CHECK(std::isnan(sine_cosine(INFINITY).cosine));
}
