#include "distributions/design.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <string>
#include <vector>

using namespace wingspread;

namespace {

constexpr std::size_t design_runs = 100000;
const std::array<std::string, 6> input_names{"root_spring",  "mid_spring",   "mass.panel_1",
                                             "mass.panel_2", "mass.panel_3", "a"};

std::vector<double> column(const Design& design, const std::string& name, std::uint64_t first = 0) {
  const PreparedDesign prepared(design, {name});
  std::vector<double> u(design_runs);
  for (std::size_t k = 0; k < design_runs; ++k) u[k] = prepared.uniform(first + k, 0);
  return u;
}

std::vector<double> column(const std::string& name, std::uint64_t seed = 1,
                           std::uint64_t first = 0) {
  return column(Design{DesignKind::random, seed, design_runs}, name, first);
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < design_runs; ++k) sum += (a[k] - 0.5) * (b[k] - 0.5);
  return 12 * sum / static_cast<double>(design_runs); // a uniform's variance is 1/12
}

// Distance of Pearson's statistic from its mean, in its standard deviations, for equal bins.
double chi_square_sigmas(const std::vector<std::size_t>& counts) {
  const double expected = static_cast<double>(design_runs) / static_cast<double>(counts.size());
  double statistic = 0;
  for (const std::size_t count : counts)
    statistic += std::pow(static_cast<double>(count) - expected, 2) / expected;
  const double freedom = static_cast<double>(counts.size() - 1);
  return (statistic - freedom) / std::sqrt(2 * freedom);
}

double pair_grid_sigmas(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<std::size_t> counts(16 * 16);
  const auto cell = [](double u) { return static_cast<std::size_t>(16 * u); };
  for (std::size_t k = 0; k < design_runs; ++k) ++counts[16 * cell(a[k]) + cell(b[k])];
  return chi_square_sigmas(counts);
}

double kolmogorov_statistic(std::vector<double> u) {
  std::ranges::sort(u);
  const double n = static_cast<double>(design_runs);
  double distance = 0;
  for (std::size_t k = 0; k < design_runs; ++k) {
    const double rank = static_cast<double>(k);
    distance = std::max({distance, u[k] - rank / n, (rank + 1) / n - u[k]});
  }
  return distance * std::sqrt(n);
}

// No correlation, and no cell of the unit square preferred: 5 sigmas, in either direction for the
// chi-square (too even is as wrong as too uneven).
void check_independent(const std::vector<double>& a, const std::vector<double>& b) {
  CHECK(std::abs(correlation(a, b)) < 5 / std::sqrt(static_cast<double>(design_runs)));
  CHECK(std::abs(pair_grid_sigmas(a, b)) < 5);
}

} // namespace

TEST_CASE("each name's draws are uniform") {
  for (const std::string& name : input_names) {
    const std::vector<double> u = column(name);
    std::vector<std::size_t> counts(256);
    for (const double value : u) ++counts[static_cast<std::size_t>(256 * value)];
    CHECK(std::abs(chi_square_sigmas(counts)) < 5);
    CHECK(kolmogorov_statistic(u) < 2.23); // exceeded by one in 10⁴
  }
}

TEST_CASE("the draws of different names are independent") {
  std::vector<std::vector<double>> columns;
  for (const std::string& name : input_names) columns.push_back(column(name));
  for (std::size_t i = 0; i < input_names.size(); ++i)
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
  std::vector<double> mixed(design_runs);
  std::vector<double> bent(design_runs);
  for (std::size_t k = 0; k < design_runs; ++k) {
    mixed[k] = u[k] < 0.05 ? u[k] : v[k];
    bent[k] = std::pow(u[k], 1.03);
  }
  CHECK(pair_grid_sigmas(u, mixed) > 5);
  CHECK(correlation(u, mixed) > 5 / std::sqrt(static_cast<double>(design_runs)));
  CHECK(kolmogorov_statistic(bent) > 2.23);
}

namespace {

constexpr std::array kinds{DesignKind::random, DesignKind::latin_hypercube, DesignKind::sobol};

/// f's mean over the runs of one replicate of a design: that of every `replicates`-th run.
template <class F>
std::vector<double> replicate_means(const Design& design, const std::vector<std::string>& of, F f) {
  const PreparedDesign prepared(design, of);
  std::vector<double> sums(design.replicates, 0), u(of.size());
  for (std::uint64_t run = 0; run < design.runs; ++run) {
    for (std::size_t i = 0; i < of.size(); ++i) u[i] = prepared.uniform(run, i);
    sums[replicate_of(design, run)] += f(u);
  }
  for (double& sum : sums)
    sum *= static_cast<double>(design.replicates) / static_cast<double>(design.runs);
  return sums;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double variance(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += std::pow(value - mean(values), 2);
  return squares / (static_cast<double>(values.size()) - 1);
}

} // namespace

TEST_CASE("a random design's draw does not depend on the numbers of runs and replicates") {
  const PreparedDesign few({DesignKind::random, 5, 100, 1}, {"a"});
  const PreparedDesign many({DesignKind::random, 5, 200, 16}, {"a"});
  for (const std::uint64_t run : {0, 1, 99}) CHECK(few.uniform(run, 0) == many.uniform(run, 0));
  CHECK(few.uniform(3, 0) == uniform(5, 3, stream_name("a")));
}

TEST_CASE("a longer Sobol' design begins with the shorter one; a Latin hypercube does not") {
  const auto begins = [](DesignKind kind) {
    const PreparedDesign few({kind, 5, 100, 4}, {"a", "b"}), many({kind, 5, 200, 4}, {"a", "b"});
    bool same = true;
    for (std::uint64_t run = 0; run < 100; ++run)
      same = same && few.uniform(run, 1) == many.uniform(run, 1);
    return same;
  };
  CHECK(begins(DesignKind::sobol));
  CHECK_FALSE(begins(DesignKind::latin_hypercube));
}

TEST_CASE("a design that says nothing of replicates is one") {
  for (const DesignKind kind : kinds) {
    const PreparedDesign unsaid({kind, 5, 64}, {"a"}), one({kind, 5, 64, 1}, {"a"});
    for (std::uint64_t run = 0; run < 64; ++run)
      CHECK(unsaid.uniform(run, 0) == one.uniform(run, 0));
  }
}

TEST_CASE("a design of which nothing is said draws at random, for no run") {
  const Design none;
  CHECK((none.kind == DesignKind::random && none.seed == 1));
  CHECK((none.runs == 0 && none.replicates == 1));
}

TEST_CASE("the order in which dispersions are listed changes no draw of any design") {
  const std::vector<std::string> forth{"a", "b", "c", "d"}, back{"d", "c", "b", "a"};
  CHECK(order_by_name({"b", "a.2", "a", "\xC3\xA9"}) == std::vector<std::size_t>{2, 1, 0, 3});
  for (const DesignKind kind : kinds) {
    const Design design{kind, 5, 50, 2};
    const PreparedDesign one(design, forth), other(design, back);
    for (std::uint64_t run = 0; run < 50; ++run)
      for (std::size_t i = 0; i < 4; ++i) CHECK(one.uniform(run, i) == other.uniform(run, 3 - i));
  }
}

TEST_CASE("every replicate of a Latin hypercube has each of its strata once") {
  for (const std::uint64_t n : {16, 47, 101}) { // replicates of 5 or 6, 15 or 16, 33 or 34 runs
    const Design design{DesignKind::latin_hypercube, 7, n, 3};
    const PreparedDesign prepared(design, {"a"});
    std::array<std::vector<double>, 3> replicates;
    for (std::uint64_t run = 0; run < n; ++run)
      replicates.at(replicate_of(design, run)).push_back(prepared.uniform(run, 0));
    for (std::vector<double>& u : replicates) {
      std::ranges::sort(u);
      for (std::size_t s = 0; s < u.size(); ++s)
        CHECK(static_cast<std::size_t>(u[s] * static_cast<double>(u.size())) == s);
    }
  }
}

// The first two names have the first two dimensions: of 2ᵐ points, one in each elementary interval.
TEST_CASE("scrambled Sobol' points are still a net in each replicate") {
  constexpr int m = 8;
  constexpr std::uint64_t replicates = 3, n = 1 << m;
  const Design design{DesignKind::sobol, 9, replicates * n, replicates};
  const PreparedDesign prepared(design, {"a", "b"});
  for (std::uint64_t replicate = 0; replicate < replicates; ++replicate)
    for (int wide = 0; wide <= m; ++wide) {
      std::vector<int> counts(n, 0);
      for (std::uint64_t i = 0; i < n; ++i) {
        const std::uint64_t run = i * replicates + replicate;
        const auto x = static_cast<std::size_t>(std::ldexp(prepared.uniform(run, 0), wide));
        const auto y = static_cast<std::size_t>(std::ldexp(prepared.uniform(run, 1), m - wide));
        ++counts[(x << (m - wide)) | y];
      }
      CHECK(std::ranges::count(counts, 1) == n);
    }
}

TEST_CASE("over seeds, a stratified design's points are uniform and its names independent") {
  for (const DesignKind kind : {DesignKind::latin_hypercube, DesignKind::sobol}) {
    std::vector<double> one_a(design_runs), one_b(design_runs), next(design_runs);
    const PreparedDesign prepared({kind, 1, 5 * design_runs, design_runs},
                                  {"a", "b"}); // five runs each
    for (std::size_t r = 0; r < design_runs; ++r) {
      one_a[r] = prepared.uniform(3 * design_runs + r, 0);
      one_b[r] = prepared.uniform(3 * design_runs + r, 1);
      next[r] =
          prepared.uniform(3 * design_runs + (r + 1) % design_runs, 0); // of the next replicate
    }
    CHECK(kolmogorov_statistic(one_a) < 2.23);
    CHECK(kolmogorov_statistic(one_b) < 2.23);
    check_independent(one_a, one_b);
    check_independent(one_a, next);
  }
}

// A product of nearly linear factors: mean 1, smooth, with interactions of all four.
TEST_CASE("stratified designs have unbiased means, of a smaller variance than independent draws") {
  const auto smooth = [](const std::vector<double>& u) {
    double product = 1;
    for (const double each : u) product *= 1 + (std::exp(each) - std::exp(1) + 1) / 4;
    return product;
  };
  const std::vector<std::string> four{"a", "b", "c", "d"};
  std::map<DesignKind, double> variances;
  for (const DesignKind kind : kinds) {
    const std::vector<double> means = replicate_means({kind, 3, 64 * 256, 64}, four, smooth);
    variances[kind] = variance(means);
    CHECK(std::abs(mean(means) - 1) < 5 * std::sqrt(variances[kind] / 64));
  }
  CHECK(variances[DesignKind::latin_hypercube] < variances[DesignKind::random] / 10);
  CHECK(variances[DesignKind::sobol] < variances[DesignKind::random] / 100);
}

TEST_CASE("replicates of a stratified design are independent of each other") {
  const auto linear = [](const std::vector<double>& u) { return u[0] + 0.3 * u[1] * u[1]; };
  for (const DesignKind kind : kinds) {
    const std::vector<double> means =
        replicate_means({kind, 11, 4000 * 8, 4000}, {"a", "b"}, linear);
    double together = 0;
    for (std::size_t r = 0; r + 1 < means.size(); r += 2)
      together += (means[r] - mean(means)) * (means[r + 1] - mean(means));
    CHECK(std::abs(together / 2000) < 5 * variance(means) / std::sqrt(2000.0));
  }
}

TEST_CASE("names beyond the first dimensions are drawn too") {
  std::vector<std::string> many;
  for (std::size_t i = 0; i < most_sobol_dimensions; ++i) many.push_back(std::to_string(i));
  const PreparedDesign prepared({DesignKind::sobol, 1, 8, 1}, many);
  const double u = prepared.uniform(7, most_sobol_dimensions - 1);
  CHECK((u > 0 && u < 1));
}
