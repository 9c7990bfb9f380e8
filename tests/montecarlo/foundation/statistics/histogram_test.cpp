#include "montecarlo/foundation/statistics/histogram.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace wingspread;

namespace {

double integral(const Histogram& h) {
  double sum = 0;
  for (std::size_t i = 0; i < h.counts.size(); ++i)
    sum += h.density(i) * (h.edges[i + 1] - h.edges[i]);
  return sum;
}

std::vector<double> normals(int n, double mean, double std) {
  std::mt19937_64 random(9);
  std::vector<double> values;
  for (int i = 0; i < n; ++i) {
    double sum = -6; // twelve uniforms: near enough to normal
    for (int j = 0; j < 12; ++j) sum += static_cast<double>(random() >> 11) * 0x1p-53;
    values.push_back(mean + std * sum);
  }
  std::ranges::sort(values);
  return values;
}

void check_sound(const Histogram& h, const std::vector<double>& sorted) {
  REQUIRE(h.edges.size() == h.counts.size() + 1);
  CHECK(std::ranges::adjacent_find(h.edges, std::ranges::greater_equal{}) == h.edges.end());
  CHECK((h.edges.front() <= sorted.front() && h.edges.back() >= sorted.back()));
  CHECK(h.total() == static_cast<long>(sorted.size()));
  CHECK(integral(h) == Approx(1).epsilon(1e-12));
}

} // namespace

TEST_CASE("histograms count every value once and integrate to 1") {
  for (const int n : {2, 3, 10, 1000, 30000}) {
    const std::vector<double> values = normals(n, 5, 2);
    check_sound(histogram(values, AutoBins{}), values);
    check_sound(histogram(values, 7), values);
    CHECK(histogram(values, 7).counts.size() == 7);
  }
}

TEST_CASE("a value on an edge counts above it, the last bin is closed") {
  const std::vector<double> values{0, 0, 1, 2, 2, 2, 3, 4, 4};
  const Histogram h = histogram(values, 4);
  CHECK(h.edges == std::vector<double>{0, 1, 2, 3, 4});
  CHECK(h.counts == std::vector<long>{2, 1, 3, 3});
  CHECK(h.density(2) == Approx(3.0 / 9));
}

// By hand: 0 … 999 has X_(250) = 249 and X_(750) = 749, so h = 2 · 500/10 = 100 and ⌈999/100⌉ = 10.
TEST_CASE("automatic bins: Freedman–Diaconis worked by hand") {
  std::vector<double> values;
  for (int i = 0; i < 1000; ++i) values.push_back(i);
  CHECK(histogram(values, AutoBins{}).counts.size() == 10);
}

TEST_CASE("automatic bins where the rule fails") {
  SECTION("no spread between the quartiles: Sturges") {
    std::vector<double> values(64, 1.0);
    values.front() = 0;
    values.back() = 2;
    CHECK(histogram(values, AutoBins{}).counts.size() == 7); // log2 64 + 1
  }
  SECTION("far outliers: capped") {
    std::vector<double> values = normals(1000, 0, 1);
    values.push_back(1e9);
    const Histogram h = histogram(values, AutoBins{});
    CHECK(h.counts.size() == most_auto_bins);
    check_sound(h, values);
  }
  SECTION("all equal, or one: a bin about it") {
    for (const double value : {0.0, 3.0, -3.0, 1e17}) {
      for (const auto& values : {std::vector{value}, std::vector(5, value)}) {
        const Histogram h = histogram(values, AutoBins{});
        CHECK(h.counts.size() == 1);
        check_sound(h, values);
        check_sound(histogram(values, 3), values);
      }
    }
  }
  SECTION("no room between neighbouring doubles") {
    const std::vector<double> values{1, std::nextafter(1, 2)};
    check_sound(histogram(values, AutoBins{}), values);
    check_sound(histogram(values, 50), values);
  }
  SECTION("no values: no bins") {
    const Histogram h = histogram({}, AutoBins{});
    CHECK((h.edges.empty() && h.counts.empty() && h.total() == 0));
  }
}
