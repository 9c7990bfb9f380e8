#include "montecarlo/results/checkpoint/shard_checkpoints.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE("the parts of an analysis are its runs, each in one shard, in the shards' order",
          "[checkpoint]") {
  for (const RunRange& range : {RunRange{0, 10}, {100, 110}, {7, 8}, {1000, 1003}, {5, 105}})
    for (const long of : {1L, 2L, 3L, 7L}) {
      CAPTURE(range.first, range.last, of);
      long next = range.first;
      for (long index = 1; index <= of; ++index) {
        const RunRange part = part_of_analysis(range, {index, of});
        CHECK(part.first == next);
        CHECK(part.size() >= range.size() / of);
        CHECK(part.size() <= range.size() / of + 1);
        next = part.last;
      }
      CHECK(next == range.last);
    }
  const RunRange middle = part_of_analysis({100, 110}, {2, 3}); // ⌊10/3⌋ up to ⌊20/3⌋ of ten
  CHECK((middle.first == 103 && middle.last == 106));
}
