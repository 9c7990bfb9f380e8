#include "distributions/sobol_sequence.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

using namespace wingspread;

namespace {

double number(std::uint64_t x) { return static_cast<double>(x >> 11) * 0x1p-53; }
std::uint64_t gray_code(std::uint64_t k) { return k ^ (k >> 1); }

/// Whether each of the 2ᵐ elementary boxes of area 2⁻ᵐ, 2⁻ᵃ wide and 2ᵃ⁻ᵐ high for every a, holds
/// one of the 2ᵐ points from `first` on.
bool is_net(const SobolDimension& one, const SobolDimension& other, unsigned m,
            std::uint64_t first) {
  const std::uint64_t n = std::uint64_t{1} << m;
  for (unsigned a = 0; a <= m; ++a) {
    std::vector<int> counts(n, 0);
    for (std::uint64_t k = first; k < first + n; ++k) {
      const std::uint64_t x = a == 0 ? 0 : sobol_coordinate(one, k) >> (64 - a);
      const std::uint64_t y = a == m ? 0 : sobol_coordinate(other, k) >> (64 - (m - a));
      ++counts[(x << (m - a)) | y];
    }
    if (std::ranges::count(counts, 1) != static_cast<std::ptrdiff_t>(n)) return false;
  }
  return true;
}

} // namespace

// scipy 1.10.1: qmc.Sobol(40, scramble=False), which has the same direction numbers and goes
// through the points in the order of their Gray code.
TEST_CASE("Sobol' points: published values") {
  const std::vector<SobolDimension> dimensions = sobol_dimensions(40);
  const struct {
    std::size_t dimension;
    std::vector<double> first;
    double point_777, point_1000;
  } published[] = {
      {0, {0, 0.5, 0.75, 0.25, 0.375, 0.875, 0.625, 0.125, 0.1875}, 0.6923828125, 0.2197265625},
      {1, {0, 0.5, 0.25, 0.75, 0.375, 0.875, 0.125, 0.625, 0.3125}, 0.9365234375, 0.0966796875},
      {2, {0, 0.5, 0.25, 0.75, 0.625, 0.125, 0.875, 0.375, 0.9375}, 0.1630859375, 0.5185546875},
      {3, {0, 0.5, 0.25, 0.75, 0.875, 0.375, 0.625, 0.125, 0.4375}, 0.2744140625, 0.6767578125},
      {9, {0, 0.5, 0.75, 0.25, 0.625, 0.125, 0.375, 0.875, 0.3125}, 0.3232421875, 0.0693359375},
      {39, {0, 0.5, 0.25, 0.75, 0.875, 0.375, 0.625, 0.125, 0.5625}, 0.3583984375, 0.4794921875}};
  for (const auto& [dimension, first, point_777, point_1000] : published) {
    CAPTURE(dimension);
    const auto point = [&, &of = dimensions[dimension]](std::uint64_t k) {
      return number(sobol_coordinate(of, gray_code(k)));
    };
    for (std::uint64_t k = 0; k < first.size(); ++k) CHECK(point(k) == first[k]);
    CHECK(point(777) == point_777);
    CHECK(point(1000) == point_1000);
  }
}

TEST_CASE("Sobol' points fill the elementary intervals of their first two dimensions evenly") {
  const std::vector<SobolDimension> dimensions = sobol_dimensions(6);
  for (unsigned m = 0; m <= 11; ++m)
    for (const std::uint64_t block : {0, 1, 5})
      CHECK(is_net(dimensions[0], dimensions[1], m, block << m));
  CHECK_FALSE(is_net(dimensions[0], dimensions[1], 5, 1)); // not a block of its own
  CHECK_FALSE(is_net(dimensions[3], dimensions[5], 5, 0)); // a pair with t > 0
}

TEST_CASE("every coordinate of Sobol' points alone is perfectly even") {
  const std::vector<SobolDimension> dimensions = sobol_dimensions(most_sobol_dimensions);
  constexpr unsigned m = 6;
  for (const SobolDimension& dimension : dimensions) {
    std::uint64_t seen = 0;
    for (std::uint64_t k = 0; k < 64; ++k)
      seen |= std::uint64_t{1} << (sobol_coordinate(dimension, k) >> (64 - m));
    if (seen != ~std::uint64_t{0}) FAIL("a coordinate misses a 64th");
    // The last direction number is odd: all 2⁶⁴ points differ.
    if (dimension[63] % 2 == 0) FAIL("a coordinate repeats itself");
  }
  CHECK(sobol_dimensions(0).empty());
}
