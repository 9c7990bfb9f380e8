#include "montecarlo/analyses/margin/margin_result.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <random>
#include <vector>

using namespace wingspread;

// Each draw on its own, from the outermost scale to the middle: once it keeps to the condition, it is out of order if it
// breaks it again.
TEST_CASE("draws out of order are those that break the condition again nearer to the middle",
          "[margin]") {
  std::mt19937_64 random(6);
  long most = 0;
  for (int trial = 0; trial < 200; ++trial) {
    constexpr long draws = 12;
    constexpr int scales = 7;
    std::vector<std::vector<bool>> breaks(draws, std::vector<bool>(scales));
    MarginSearch search;
    for (int k = 0; k < scales; ++k) {
      Verdict verdict;
      for (long draw = 0; draw < draws; ++draw)
        if ((breaks[static_cast<std::size_t>(draw)][static_cast<std::size_t>(k)] =
                 random() % 3 == 0))
          verdict.broken.push_back(draw);
      CaseResult one;
      one.verdicts = {verdict};
      search.seen[0.5 + 0.1 * k] = {one};
    }
    const auto middle = static_cast<int>(random() % scales);
    const auto again = [&](int from, int step) {
      return std::ranges::count_if(breaks, [&](const std::vector<bool>& draw) {
        bool kept = false;
        for (int k = from; k != middle + step; k += step) {
          const bool broken = draw[static_cast<std::size_t>(k)];
          if (kept && broken) return true;
          kept = kept || !broken;
        }
        return false;
      });
    };
    const OutOfOrder found = out_of_order(search, {0, 0}, 0.5 + 0.1 * middle);
    CAPTURE(middle);
    CHECK(found.lower == again(0, 1));
    CHECK(found.upper == again(scales - 1, -1));
    most = std::max(most, found.lower);
  }
  CHECK(most > 5);
}
