#include "distributions/sobol_sequence.hpp"

#include <boost/random/sobol.hpp>

#include <bit>
#include <cassert>

namespace wingspread {
namespace {

using Engine = boost::random::sobol_engine<std::uint64_t, 64>;
static_assert(boost::random::default_sobol_table::max_dimension == most_sobol_dimensions);

} // namespace

// Boost's engine uses Gray-code order: its point n is (1) with the digits of n ⊕ ⌊n/2⌋ in place of k. For n = 2ʲ⁺¹ − 1
// this Gray code is 2ʲ, so that the point is v_j. The engine leaves out point 0, so seed(n − 1) moves it to point n.
std::vector<SobolDimension> sobol_dimensions(std::size_t count) {
  assert(count <= most_sobol_dimensions);
  std::vector<SobolDimension> dimensions(count);
  if (count == 0) return dimensions;
  Engine engine(count);
  for (std::size_t j = 0; j < 64; ++j) {
    engine.seed((~std::uint64_t{0} >> (63 - j)) - 1);
    for (SobolDimension& dimension : dimensions) dimension[j] = engine();
  }
  return dimensions;
}

std::uint64_t sobol_coordinate(const SobolDimension& dimension, std::uint64_t k) {
  std::uint64_t x = 0;
  for (; k != 0; k &= k - 1) x ^= dimension[static_cast<std::size_t>(std::countr_zero(k))];
  return x;
}

} // namespace wingspread
