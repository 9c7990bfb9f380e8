#include "montecarlo/foundation/statistics/number_sort.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <limits>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("numbers are sorted as comparisons sort them, few and many, of every size and sign") {
  std::mt19937_64 random(11);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const std::size_t n : {0u, 1u, 2u, 2999u, 3000u, 50'000u}) {
    std::vector<double> values(n);
    for (double& value : values) {
      const double size = std::exp(1400 * (uniform(random) - 0.5)); // 1e-304 … 1e304
      value = uniform(random) < 0.1 ? 0.25 : uniform(random) < 0.5 ? size : -size;
    }
    if (n > 2) values[0] = infinity, values[1] = -infinity, values[2] = 5e-324;
    std::vector<double> expected = values;
    std::ranges::sort(expected);
    sort_numbers(values);
    CAPTURE(n);
    CHECK(values == expected);
  }
}

TEST_CASE("items of one number keep their order, whichever digits the numbers differ in") {
  struct Item {
    double value;
    int place;
  };
  for (const double step : {1.0, 1e-300, 0x1p-52}) {
    std::vector<Item> items;
    for (int place = 0; place < 20'000; ++place)
      items.push_back({1 + step * (place * 7919 % 100), place});
    sort_by_number(std::span(items), [](const Item& item) { return item.value; });
    for (std::size_t k = 1; k < items.size(); ++k) {
      REQUIRE(items[k - 1].value <= items[k].value);
      if (items[k - 1].value == items[k].value) REQUIRE(items[k - 1].place < items[k].place);
    }
  }
}

TEST_CASE("the bits of a double stand in the order of the numbers") {
  const double infinity = std::numeric_limits<double>::infinity();
  double last = -infinity;
  for (const double next : {-1e300, -1.0, -5e-324, 0.0, 5e-324, 1.0, 1e300, infinity}) {
    CHECK(order_bits(last) < order_bits(next));
    last = next;
  }
  CHECK(order_bits(-0.0) < order_bits(0.0));
}
