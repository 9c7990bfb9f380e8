#include "montecarlo/foundation/platform/live_histogram.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;

TEST_CASE("a live histogram begins with its first values, and counts all that follow") {
  LiveHistogram histogram("time", "s");
  for (int k = 0; k < 49; ++k) histogram.add(k < 25 ? 1 : 3);
  histogram.add(std::nan(""));
  CHECK(histogram.text().empty());
  histogram.add(
      3); // 25 of each: from 0.5 to 3.5 in 48 bins, 1 in the ninth and 3 in the forty-first
  const std::string blank8(8, ' '), blank31(31, ' '), blank7(7, ' ');
  CHECK(histogram.text() == "time 0.5 " + blank8 + "█" + blank31 + "█" + blank7 + " 3.5 s");
  for (int k = 0; k < 75; ++k) histogram.add(1);
  histogram.add(99); // beyond the range: in the last bin
  CHECK(histogram.text() ==
        "time 0.5 " + blank8 + "█" + blank31 + "▂" + std::string(6, ' ') + "▁ 3.5 s");
}

TEST_CASE("of equal values a live histogram waits for others") {
  LiveHistogram histogram("x", "");
  for (int k = 0; k < 120; ++k) histogram.add(2);
  CHECK(histogram.text().empty());
  for (int k = 0; k < 30; ++k) histogram.add(k);
  CHECK(!histogram.text().empty());
}
