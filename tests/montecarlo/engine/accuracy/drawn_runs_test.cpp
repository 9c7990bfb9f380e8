#include "montecarlo/engine/accuracy/accuracy.hpp"
#include "montecarlo/engine/accuracy/drawn_runs.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace wingspread;

namespace {

Results rows_with(long runs, const std::vector<long>& failed = {}) {
  Results results(ResultNames{{}, {}});
  for (long k = 0; k < runs; ++k) {
    const bool fails = std::ranges::count(failed, k) > 0;
    const Status status = !fails ? Status::stalled : k % 2 == 0 ? Status::failed : Status::invalid;
    results.append({k, status, {}, {}, "", "", {}});
  }
  return results;
}

} // namespace

TEST_CASE("every run is drawn equally often, and none twice", "[accuracy]") {
  const Results results = rows_with(40, {3, 8});
  std::vector<int> times(40, 0);
  constexpr int seeds = 2000, count = 7;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const std::vector<std::size_t> rows = drawn_rows(results, seed, count);
    REQUIRE(rows.size() == count);
    REQUIRE(std::ranges::adjacent_find(rows, std::greater_equal{}) == rows.end());
    for (const std::size_t row : rows) ++times[row];
  }
  CHECK((times[3] == 0 && times[8] == 0));
  const double p = count / 38.0, spread = std::sqrt(seeds * p * (1 - p));
  for (std::size_t row = 0; row < 40; ++row)
    if (row != 3 && row != 8) CHECK(std::abs(times[row] - seeds * p) < 4.5 * spread);
}

TEST_CASE("a run's being drawn depends on its number, not on its row or its neighbours",
          "[accuracy]") {
  const Results all = rows_with(200);
  Results odd(ResultNames{{}, {}});
  for (long k = 1; k < 200; k += 2) odd.append(all.row(static_cast<std::size_t>(k)));
  const std::vector<std::size_t> of_all = drawn_rows(all, 5, 200), of_odd = drawn_rows(odd, 5, 30);
  CHECK(of_all.size() == 200);
  // The order of ranks: each count's sample holds that of a smaller count.
  for (std::size_t count = 1; count < 30; ++count) {
    const auto fewer = drawn_rows(odd, 5, count), more = drawn_rows(odd, 5, count + 1);
    CHECK(std::ranges::includes(more, fewer));
  }
  const auto most = drawn_rows(all, 5, 120);
  std::vector<std::size_t> of_these;
  for (const std::size_t row : most)
    if (row % 2 == 1) of_these.push_back(row / 2);
  CHECK(drawn_rows(odd, 5, of_these.size()) == of_these);
  CHECK(drawn_rows(all, 6, 30) != drawn_rows(all, 5, 30));
}

TEST_CASE("no more runs are drawn than there are", "[accuracy]") {
  CHECK(drawn_rows(rows_with(5, {1, 3}), 1, 24) == std::vector<std::size_t>{0, 2, 4});
  CHECK(drawn_rows(rows_with(2, {0, 1}), 1, 24).empty());
  CHECK(drawn_rows(rows_with(5), 1, 0).empty());
}

TEST_CASE("the bound of the share of runs beyond an error keeps its confidence", "[accuracy]") {
  // Of 500 runs, `bad` have a large error; the runs drawn see some of them.
  const Results results = rows_with(500);
  for (const std::size_t bad : {0U, 2U, 10U, 60U})
    for (const double confidence : {0.9, 0.95}) {
      int missed = 0;
      constexpr int seeds = 400;
      for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        Accuracy accuracy;
        accuracy.runs = 50;
        std::size_t seen = 0;
        for (const std::size_t row : drawn_rows(results, seed, 50)) seen += row < bad ? 1 : 0;
        const double truth = static_cast<double>(bad) / 500;
        missed += share_at_most(accuracy, seen, confidence) < truth ? 1 : 0;
      }
      const double risk = 1 - confidence;
      CHECK(missed <= seeds * risk + 3 * std::sqrt(seeds * risk * confidence));
    }
}
