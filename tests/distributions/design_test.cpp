#include "distributions/design.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

using namespace wingspread;

namespace {

constexpr std::size_t runs = 100000;
const std::array<std::string, 6> names{"root_spring",  "mid_spring",   "mass.panel_1",
                                       "mass.panel_2", "mass.panel_3", "a"};

std::vector<double> column(const std::string& name, std::uint64_t seed = 1,
                           std::uint64_t first = 0) {
  std::vector<double> u(runs);
  for (std::size_t k = 0; k < runs; ++k)
    u[k] = uniform(Design{DesignKind::random, seed, runs}, first + k, stream_name(name));
  return u;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < runs; ++k) sum += (a[k] - 0.5) * (b[k] - 0.5);
  return 12 * sum / static_cast<double>(runs); // a uniform's variance is 1/12
}

// Distance of Pearson's statistic from its mean, in its standard deviations, for equal bins.
double chi_square_sigmas(const std::vector<std::size_t>& counts) {
  const double expected = static_cast<double>(runs) / static_cast<double>(counts.size());
  double statistic = 0;
  for (const std::size_t count : counts)
    statistic += std::pow(static_cast<double>(count) - expected, 2) / expected;
  const double freedom = static_cast<double>(counts.size() - 1);
  return (statistic - freedom) / std::sqrt(2 * freedom);
}

double pair_grid_sigmas(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<std::size_t> counts(16 * 16);
  const auto cell = [](double u) { return static_cast<std::size_t>(16 * u); };
  for (std::size_t k = 0; k < runs; ++k) ++counts[16 * cell(a[k]) + cell(b[k])];
  return chi_square_sigmas(counts);
}

double kolmogorov_statistic(std::vector<double> u) {
  std::ranges::sort(u);
  const double n = static_cast<double>(runs);
  double distance = 0;
  for (std::size_t k = 0; k < runs; ++k) {
    const double rank = static_cast<double>(k);
    distance = std::max({distance, u[k] - rank / n, (rank + 1) / n - u[k]});
  }
  return distance * std::sqrt(n);
}

// No correlation, and no cell of the unit square preferred: 5 sigmas, in either direction for the
// chi-square (too even is as wrong as too uneven).
void check_independent(const std::vector<double>& a, const std::vector<double>& b) {
  CHECK(std::abs(correlation(a, b)) < 5 / std::sqrt(static_cast<double>(runs)));
  CHECK(std::abs(pair_grid_sigmas(a, b)) < 5);
}

} // namespace

TEST_CASE("each name's draws are uniform") {
  for (const std::string& name : names) {
    const std::vector<double> u = column(name);
    std::vector<std::size_t> counts(256);
    for (const double value : u) ++counts[static_cast<std::size_t>(256 * value)];
    CHECK(std::abs(chi_square_sigmas(counts)) < 5);
    CHECK(kolmogorov_statistic(u) < 2.23); // exceeded by one in 10⁴
  }
}

TEST_CASE("the draws of different names are independent") {
  std::vector<std::vector<double>> columns;
  for (const std::string& name : names) columns.push_back(column(name));
  for (std::size_t i = 0; i < names.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) check_independent(columns[i], columns[j]);
}

TEST_CASE("the draws of neighbouring runs and neighbouring seeds are independent") {
  const std::vector<double> u = column("a");
  check_independent(u, column("a", 1, 1));
  check_independent(u, column("a", 2));
}

TEST_CASE("the checks of uniformity and independence can fail") {
  const std::vector<double> u = column("a");
  const std::vector<double> v = column("b");
  std::vector<double> mixed(runs);
  std::vector<double> bent(runs);
  for (std::size_t k = 0; k < runs; ++k) {
    mixed[k] = u[k] < 0.05 ? u[k] : v[k];
    bent[k] = std::pow(u[k], 1.03);
  }
  CHECK(pair_grid_sigmas(u, mixed) > 5);
  CHECK(correlation(u, mixed) > 5 / std::sqrt(static_cast<double>(runs)));
  CHECK(kolmogorov_statistic(bent) > 2.23);
}

TEST_CASE("a random design's draw does not depend on the number of runs") {
  const StreamName name = stream_name("a");
  for (std::uint64_t run : {0, 1, 99})
    CHECK(uniform(Design{DesignKind::random, 5, 100}, run, name) ==
          uniform(Design{DesignKind::random, 5, 200}, run, name));
  CHECK(uniform(Design{DesignKind::random, 5, 100}, 3, name) == uniform(5, 3, name));
}

TEST_CASE("a design that is not there yet cannot be used") {
  CHECK(is_available(DesignKind::random));
  for (const DesignKind kind : {DesignKind::latin_hypercube, DesignKind::sobol}) {
    CHECK_FALSE(is_available(kind));
    CHECK_THROWS_WITH(uniform(Design{kind, 1, 100}, 0, stream_name("a")),
                      "this design is not available");
  }
}
