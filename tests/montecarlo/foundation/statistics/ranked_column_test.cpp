#include "montecarlo/foundation/statistics/ranked_column.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <limits>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("tied values share the mean of their ranks, and what is missing has none") {
  const Spilled<double> values{2, none, 1, 2, 5};
  const RankedColumn column(values);
  CHECK_FALSE(column.complete());
  CHECK(column.doubled_ranks() == Spilled<std::uint32_t>{5, 0, 2, 5, 8}); // 2.5, 1, 2.5, 4

  const Spilled<double> whole{3, -1, 3};
  const RankedColumn complete(whole);
  CHECK(complete.complete());
  CHECK(complete.ranks() == std::vector<double>{2.5, 1, 2.5});
}

TEST_CASE("ranks of some rows are those among themselves") {
  const Spilled<double> values{2, none, 1, 2, 5, 0};
  const RankedColumn column(values);
  CHECK(column.ranks_where({true, false, true, true, false, false}) ==
        std::vector<double>{2.5, 1, 2.5});
  CHECK(column.ranks_where({false, false, false, true, true, true}) ==
        std::vector<double>{2, 3, 1});
  CHECK(column.ranks_where({false, false, false, false, false, false}).empty());
}

TEST_CASE("several columns are ranked as each by itself, on any number of threads") {
  const Spilled<double> a{3, 1, 2}, b{none, 7, 7};
  for (const int threads : {1, 2, 3}) {
    const auto ranked = rank_columns(std::vector{&a, &b}, threads);
    REQUIRE(ranked.size() == 2);
    CHECK(ranked[0].doubled_ranks() == RankedColumn(a).doubled_ranks());
    CHECK(ranked[1].doubled_ranks() == RankedColumn(b).doubled_ranks());
    CHECK((&ranked[0].values() == &a && &ranked[1].values() == &b));
  }
  CHECK(rank_columns({}).empty());
}
