#include "montecarlo/results/streaming/exact_sum.hpp"

#include <boost/multiprecision/cpp_int.hpp>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace wingspread;

namespace {

std::string bytes_of(const ExactSum& sum) {
  StateWriter to;
  sum.write(to);
  return std::move(to).finish();
}

/// Numbers of all magnitudes and both signs.
std::vector<double> numbers(int count, int exponents) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> mantissa(-2, 2);
  std::uniform_int_distribution<int> exponent(-exponents, exponents);
  std::vector<double> all;
  for (int i = 0; i < count; ++i) all.push_back(std::ldexp(mantissa(random), exponent(random)));
  return all;
}

/// Σ x exactly, in units of 2^-1074, as whole numbers of any length have it.
double exactly(const std::vector<double>& terms) {
  using Integer = boost::multiprecision::cpp_int;
  Integer sum = 0;
  for (const double term : terms) {
    int exponent = 0;
    const double mantissa = std::frexp(std::abs(term), &exponent);
    const int up = std::max(exponent, -1021) - 53 + 1074;
    const Integer whole =
        Integer(static_cast<long long>(std::ldexp(mantissa, 53 + std::min(0, exponent + 1021))))
        << up;
    sum += term < 0 ? -whole : whole;
  }
  const bool negative = sum < 0;
  if (negative) sum = -sum;
  if (sum == 0) return 0;
  const int top = static_cast<int>(msb(sum)), down = std::max(0, top - 62);
  const double value =
      std::ldexp(static_cast<double>(static_cast<long long>(sum >> down)), down - 1074);
  return negative ? -value : value;
}

} // namespace

TEST_CASE("exact sum: of terms of all magnitudes it is the nearest double or its neighbour") {
  for (const int exponents : {3, 60, 900}) {
    const std::vector<double> terms = numbers(5000, exponents);
    ExactSum sum;
    for (const double term : terms) sum.add(term);
    const double expected = exactly(terms);
    CHECK(std::abs(sum.value() - expected) <=
          std::abs(expected) * std::numeric_limits<double>::epsilon());
  }
}

TEST_CASE("exact sum: what cancels leaves what is left, to the last bit") {
  ExactSum sum;
  for (const double term : {1e300, 1.0, -1e300, 1e-300, -1.0}) sum.add(term);
  CHECK(sum.value() == 1e-300);
  sum.subtract(1e-300);
  CHECK(sum.value() == 0);
  sum.add(-5e-324); // the least there is
  CHECK(sum.value() == -5e-324);
  CHECK(bytes_of(sum) != bytes_of(ExactSum()));
}

TEST_CASE("exact sum: the same in any order and however it is shared out") {
  std::vector<double> terms = numbers(9000, 300); // carries are due four times
  ExactSum all;
  for (const double term : terms) all.add(term);
  std::shuffle(terms.begin(), terms.end(), std::mt19937(3));
  ExactSum parts[3], together;
  for (std::size_t i = 0; i < terms.size(); ++i)
    parts[i < 100 ? 0 : i < 5000 ? 1 : 2].add(terms[i]);
  for (const int part : {2, 0, 1}) together.add(parts[part]);
  CHECK(bytes_of(together) == bytes_of(all));
  together.subtract(parts[1]);
  together.subtract(parts[2]);
  CHECK(bytes_of(together) == bytes_of(parts[0]));
}

TEST_CASE("exact sum: what is no number spoils it, and it reads back as it was written") {
  ExactSum sum;
  for (const double term : numbers(3000, 200)) sum.add(term);
  StateReader from(bytes_of(sum), "a sum");
  ExactSum read;
  read.read(from);
  CHECK(bytes_of(read) == bytes_of(sum));
  sum.add(std::numeric_limits<double>::infinity());
  CHECK(std::isnan(sum.value()));
}
