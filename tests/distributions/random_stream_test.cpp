#include "distributions/random_stream.hpp"

#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace wingspread;

// Random123 1.14, tests/kat_vectors, the three lines "philox4x64 10".
TEST_CASE("philox gives the generator's published answers") {
  constexpr std::uint64_t ones = ~std::uint64_t{0};
  CHECK(philox({0, 0}, {0, 0, 0, 0}) == PhiloxBlock{0x16554d9eca36314c, 0xdb20fe9d672d0fdc,
                                                    0xd7e772cee186176b, 0x7e68b68aec7ba23b});
  CHECK(
      philox({ones, ones}, {ones, ones, ones, ones}) ==
      PhiloxBlock{0x87b092c3013fe90b, 0x438c3c67be8d0224, 0x9cc7d7c69cd777b6, 0xa09caebf594f0ba0});
  CHECK(
      philox({0x452821e638d01377, 0xbe5466cf34e90c6c},
             {0x243f6a8885a308d3, 0x13198a2e03707344, 0xa4093822299f31d0, 0x082efa98ec4e6c89}) ==
      PhiloxBlock{0xa528f45403e61d95, 0x38c72dbd566e9788, 0xa5a1610e72fd18b5, 0x57bd43b5e52b7fe6});
}

// The FNV authors' test vectors (fnv64 test suite; RFC 9923).
TEST_CASE("a name's stream is its FNV-1a hash") {
  static_assert(stream_name("").hash == 0xcbf29ce484222325);
  static_assert(stream_name("a").hash == 0xaf63dc4c8601ec8c);
  static_assert(stream_name("foobar").hash == 0x85944171f73967e8);
  CHECK(stream_name("mass.panel_1") != stream_name("mass.panel_2"));
  CHECK(stream_name("\xc3\xa9").hash == 0x0ac21707b7181e01); // bytes count as unsigned
}

TEST_CASE("a draw is the first number of the stream with its seed, run and name in their words") {
  const StreamName name = stream_name("root_spring");
  const PhiloxBlock first = philox({7, 0}, {0, 41, name.hash, 0});
  const PhiloxBlock second = philox({7, 0}, {1, 41, name.hash, 0});
  RandomStream stream(7, 41, name);
  for (const std::uint64_t word : first) CHECK(stream() == word);
  for (const std::uint64_t word : second) CHECK(stream() == word);
  CHECK(uniform(7, 41, name) == open_uniform(first[0]));
}

TEST_CASE("open uniforms are exact, symmetric and never 0 or 1") {
  constexpr std::uint64_t ones = ~std::uint64_t{0};
  CHECK(open_uniform(0) == 0x1p-53);
  CHECK(open_uniform(ones) == 1 - 0x1p-53);
  CHECK(open_uniform(std::uint64_t{1} << 63) == 0.5 + 0x1p-53);
  RandomStream stream(1, 0, stream_name("bits"));
  for (int i = 0; i < 1000; ++i) {
    const std::uint64_t bits = stream();
    const double u = open_uniform(bits);
    CHECK(open_uniform(~bits) == 1 - u); // the mirrored bits give the mirrored number
    CHECK(1 - (1 - u) == u);             // nothing lost in either direction
  }
}

TEST_CASE("a draw is pure: any order gives the same bits") {
  const std::array names{stream_name("a"), stream_name("b"), stream_name("mass.panel_1")};
  std::vector<double> forwards;
  std::vector<double> backwards;
  for (std::uint64_t run = 0; run < 100; ++run)
    for (const StreamName name : names) forwards.push_back(uniform(3, run, name));
  for (std::uint64_t run = 100; run-- > 0;)
    for (std::size_t i = names.size(); i-- > 0;) backwards.push_back(uniform(3, run, names[i]));
  std::ranges::reverse(backwards);
  CHECK(forwards == backwards);
  std::ranges::sort(forwards);
  CHECK(std::ranges::adjacent_find(forwards) == forwards.end()); // and no two draws share a number
}

TEST_CASE("seed, run and name each change the draw") {
  const double u = uniform(1, 2, stream_name("a"));
  CHECK(uniform(2, 2, stream_name("a")) != u);
  CHECK(uniform(1, 3, stream_name("a")) != u);
  CHECK(uniform(1, 2, stream_name("b")) != u);
  CHECK(uniform(2, 1, stream_name("a")) != u); // seed and run do not trade places
}

TEST_CASE("a stream drives the distributions of Boost.Random and std") {
  static_assert(std::uniform_random_bit_generator<RandomStream>);
  constexpr int n = 100000;
  RandomStream stream(1, 0, stream_name("boost"));
  boost::random::uniform_01<double> uniform_01;
  boost::random::normal_distribution<double> normal;
  std::uniform_int_distribution<int> die(1, 6);
  double uniforms = 0;
  double normals = 0;
  double pips = 0;
  for (int i = 0; i < n; ++i) {
    uniforms += uniform_01(stream);
    normals += normal(stream);
    pips += die(stream);
  }
  const double root = std::sqrt(n); // each mean within 5 standard errors
  CHECK(std::abs(uniforms / n - 0.5) < 5 * std::sqrt(1. / 12) / root);
  CHECK(std::abs(normals / n) < 5 / root);
  CHECK(std::abs(pips / n - 3.5) < 5 * std::sqrt(35. / 12) / root);
}
