#include "distributions/latin_hypercube.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

using namespace wingspread;

namespace {

ReplicateStream stream(std::uint64_t replicate, const char* name = "a") {
  return {1, stream_name(name), replicate};
}

std::vector<std::uint64_t> strata(std::uint64_t n, const ReplicateStream& of) {
  std::vector<std::uint64_t> all(n);
  for (std::uint64_t i = 0; i < n; ++i) all[i] = latin_stratum(i, n, of);
  return all;
}

/// Distance of Pearson's statistic from its mean, in its standard deviations.
double chi_square_sigmas(const std::vector<int>& counts, double expected) {
  double statistic = 0;
  for (const int count : counts) statistic += std::pow(count - expected, 2) / expected;
  const double freedom = static_cast<double>(counts.size()) - 1;
  return (statistic - freedom) / std::sqrt(2 * freedom);
}

} // namespace

TEST_CASE("a Latin hypercube has each stratum exactly once, whatever their number") {
  for (const std::uint64_t n :
       {1, 2, 3, 4, 5, 6, 7, 15, 16, 17, 97, 625, 1000, 1024, 4099, 10007}) {
    CAPTURE(n);
    std::vector<int> counts(n, 0);
    bool inside = true;
    for (std::uint64_t i = 0; i < n; ++i) {
      const std::uint64_t s = latin_stratum(i, n, stream(3));
      REQUIRE(s < n);
      ++counts[s];
      // u ≥ s/n and u < (s + 1)/n; the sign of a fused multiply-add is exact.
      const double u = latin_coordinate(i, n, stream(3)), size = static_cast<double>(n);
      inside = inside && std::fma(u, size, -static_cast<double>(s)) >= 0 &&
               std::fma(u, size, -static_cast<double>(s + 1)) < 0;
    }
    CHECK(std::ranges::count(counts, 1) == static_cast<std::ptrdiff_t>(n));
    CHECK(inside);
  }
}

TEST_CASE(
    "a Latin hypercube's coordinates are strictly within (0, 1), with their complements exact") {
  const std::uint64_t large = std::uint64_t{1} << 51;
  for (const std::uint64_t n : {std::uint64_t{1}, std::uint64_t{3}, large, large - 1})
    for (std::uint64_t k = 0; k < 1000; ++k) {
      const double u = latin_coordinate(k < n ? k : n - 1, n, stream(k));
      const double digits = std::ldexp(u, 53);
      CHECK((u > 0 && u < 1 && digits == std::floor(digits) && std::fmod(digits, 2) == 1));
    }
}

// All permutations of five strata, one as often as another.
TEST_CASE("every permutation is as likely as any other") {
  std::map<std::vector<std::uint64_t>, int> counts;
  constexpr int keys = 12000;
  for (std::uint64_t r = 0; r < keys; ++r) ++counts[strata(5, stream(r))];
  CHECK(counts.size() == 120);
  std::vector<int> numbers;
  for (const auto& [permutation, count] : counts) numbers.push_back(count);
  CHECK(std::abs(chi_square_sigmas(numbers, keys / 120.0)) < 5);
}

// What the variance of a mean depends on: where two points lie with respect to each other.
TEST_CASE("two points' strata are any two with equal probability") {
  constexpr std::uint64_t n = 23;
  constexpr int keys = 25300;
  for (const std::uint64_t other : {1u, 5u, 22u}) {
    std::vector<int> pairs(n * (n - 1), 0), single(n, 0);
    for (std::uint64_t r = 0; r < keys; ++r) {
      const std::uint64_t a = latin_stratum(0, n, stream(r)),
                          b = latin_stratum(other, n, stream(r));
      ++pairs[a * (n - 1) + (b + n - a) % n - 1];
      ++single[a];
    }
    CHECK(std::abs(chi_square_sigmas(pairs, keys / (n * (n - 1.0)))) < 5);
    CHECK(std::abs(chi_square_sigmas(single, keys / static_cast<double>(n))) < 5);
  }
}

TEST_CASE("within its stratum a point is anywhere") {
  constexpr int keys = 20000;
  std::vector<int> counts(100, 0);
  for (std::uint64_t r = 0; r < keys; ++r) {
    const double position = 7 * latin_coordinate(2, 7, stream(r));
    ++counts[static_cast<std::size_t>(100 * (position - std::floor(position)))];
  }
  CHECK(std::abs(chi_square_sigmas(counts, keys / 100.)) < 5);
}

TEST_CASE("two points of a replicate lie in their strata independently of each other") {
  constexpr int keys = 20000;
  const auto cell = [](std::uint64_t i, std::uint64_t r) {
    const double position = 7 * latin_coordinate(i, 7, stream(r));
    return static_cast<std::size_t>(10 * (position - std::floor(position)));
  };
  for (const std::uint64_t other : {1u, 3u, 6u}) {
    std::vector<int> counts(100, 0);
    for (std::uint64_t r = 0; r < keys; ++r) ++counts[10 * cell(0, r) + cell(other, r)];
    CHECK(std::abs(chi_square_sigmas(counts, keys / 100.)) < 5);
  }
}

TEST_CASE("another seed, name or replicate permutes otherwise") {
  const auto as_it_is = strata(50, {1, {7}, 0});
  CHECK(strata(50, {1, {7}, 0}) == as_it_is);
  CHECK(strata(50, {2, {7}, 0}) != as_it_is);
  CHECK(strata(50, {1, {8}, 0}) != as_it_is);
  CHECK(strata(50, {1, {7}, 1}) != as_it_is);
}

// Computed in Python by a transcription of the header's description, over a Philox of its own.
TEST_CASE("a Latin hypercube's strata and coordinates: reference values") {
  using Strata = std::vector<std::uint64_t>;
  const ReplicateStream of = stream(2, "spring");
  CHECK(strata(7, of) == Strata{2, 4, 3, 5, 6, 0, 1});
  Strata first;
  for (std::uint64_t i = 0; i < 7; ++i) first.push_back(latin_stratum(i, 1000, of));
  CHECK(first == Strata{905, 573, 26, 533, 7, 174, 620});
  CHECK(latin_coordinate(0, 7, of) == 0x1.251375df4832ap-2);
  CHECK(latin_coordinate(1, 7, of) == 0x1.63bf06a876979p-1);
  CHECK(latin_coordinate(0, 1000, of) == 0x1.cf5c9cb3576bbp-1);
  CHECK(latin_coordinate(3, 1000, of) == 0x1.10ffa8929fc9fp-1);
}
