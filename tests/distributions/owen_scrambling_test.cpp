#include "distributions/owen_scrambling.hpp"

#include <catch2/catch.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

using namespace wingspread;

namespace {

std::uint64_t scrambled(std::uint64_t x, std::uint64_t replicate) {
  return owen_scrambled(x, {1, stream_name("a"), replicate});
}

/// The first digit in which two coordinates differ, from 0.
int first_difference(std::uint64_t a, std::uint64_t b) { return std::countl_zero(a ^ b); }

} // namespace

TEST_CASE("scrambling keeps what coordinates have in common, and where they part") {
  for (std::uint64_t k = 0; k < 2000; ++k) {
    const PhiloxBlock bits = philox({1, 99}, {0, k, 0, 0});
    const int common = static_cast<int>(k % 56);
    const std::uint64_t other = bits[0] ^ (std::uint64_t{1} << (63 - common)) ^
                                ((bits[1] >> 1) >> common); // digits after it at random
    REQUIRE(first_difference(bits[0], other) == common);
    CHECK(first_difference(scrambled(bits[0], k), scrambled(other, k)) == common);
  }
}

TEST_CASE("each digit is flipped as often as not, whatever the digits before it") {
  constexpr int replicates = 2000;
  const double five_sigmas = 5 * std::sqrt(replicates / 4.0);
  for (const std::uint64_t x : {std::uint64_t{0}, ~std::uint64_t{0}, 0x123456789abcdef0u}) {
    std::vector<int> flips(56, 0);
    for (int r = 0; r < replicates; ++r)
      for (unsigned digit = 0; digit < 56; ++digit)
        flips[digit] += static_cast<int>(((scrambled(x, r) ^ x) >> (63 - digit)) & 1);
    for (const int count : flips) CHECK(std::abs(count - replicates / 2.0) < five_sigmas);
  }
}

// The flip of digit d may depend on the digits before it alone, and has to: two coordinates that
// part before it must have independent flips, and two that part at it or after it the same.
TEST_CASE("flips of different branches are independent, those of one branch the same") {
  constexpr int replicates = 2000;
  const auto agreement = [&](std::uint64_t x, std::uint64_t y, unsigned digit) {
    int agree = 0;
    for (int r = 0; r < replicates; ++r) {
      const std::uint64_t differ = (scrambled(x, r) ^ x) ^ (scrambled(y, r) ^ y);
      agree += ((differ >> (63 - digit)) & 1) == 0;
    }
    return agree;
  };
  const std::uint64_t x = 0x5a5a5a5a5a5a5a5au;
  for (const unsigned part : {0u, 1u, 6u, 7u, 8u, 9u, 15u, 16u, 30u}) {
    const std::uint64_t y = x ^ (std::uint64_t{1} << (63 - part));
    for (const unsigned digit : {0u, 1u, 7u, 8u, 12u, 16u, 31u, 55u}) {
      CAPTURE(part, digit);
      if (digit <= part)
        CHECK(agreement(x, y, digit) == replicates);
      else
        CHECK(std::abs(agreement(x, y, digit) - replicates / 2.0) <
              5 * std::sqrt(replicates / 4.0));
    }
  }
}

TEST_CASE("another seed, name or replicate scrambles otherwise") {
  const std::uint64_t x = 0x0123456789abcdefu, as_it_is = owen_scrambled(x, {1, {7}, 0});
  CHECK(owen_scrambled(x, {1, {7}, 0}) == as_it_is);
  CHECK(owen_scrambled(x, {2, {7}, 0}) != as_it_is);
  CHECK(owen_scrambled(x, {1, {8}, 0}) != as_it_is);
  CHECK(owen_scrambled(x, {1, {7}, 1}) != as_it_is);
}
