#include "montecarlo/report/data/order_split.hpp"
#include "tests/montecarlo/report/data/page_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// Rows with these orders and a value each.
Results rows_with(const std::vector<std::pair<std::string, double>>& rows) {
  Results results(ResultNames{{}, {"x"}, false});
  long run = 0;
  for (const auto& [order, value] : rows)
    results.append(
        {run++, order.empty() ? Status::stalled : Status::deployed, {}, {value}, order, ""});
  return results;
}

} // namespace

TEST_CASE("histograms by order of latching add up to the histogram, by hand", "[page]") {
  const Results results = rows_with(
      {{"a>b", 0}, {"b>a", 1}, {"a>b", 2}, {"", 4}, {"a>b", nothing}, {"b>a", 2}, {"a>b", 4}});
  const Summary summary = summarize(results, {});
  const OrderSplit split(results, summary);
  REQUIRE(split.groups().size() == 3);
  CHECK(split.groups()[0].name == "a>b");
  CHECK(split.groups()[0].count == 4);
  CHECK(split.groups()[2].name == "no latch");
  CHECK(split.groups()[2].count == 1);
  CHECK(split.of_row(3) == 2);
  const Histogram bins{{0, 2, 4}, {2, 4}}; // 0, 1 | 2, 4, 2, 4: an inner edge counts above it
  const auto counts = split.counts(bins, results.outputs[0].values);
  CHECK(counts == std::vector<std::vector<long>>{{1, 2}, {1, 1}, {0, 1}});
}

TEST_CASE("orders beyond the six most frequent stand together", "[page]") {
  std::vector<std::pair<std::string, double>> rows;
  for (int order = 0; order < 9; ++order)
    for (int k = 0; k < 10 - order; ++k)
      rows.emplace_back(std::string(1, char('a' + order)), order);
  const Results results = rows_with(rows);
  const OrderSplit split(results, summarize(results, {}));
  REQUIRE(split.groups().size() == 7);
  CHECK(split.groups()[5].name == "f");
  CHECK(split.groups()[6].name == "others");
  CHECK(split.groups()[6].count == 4 + 3 + 2);
  long sum = 0;
  const Histogram whole{{0, 8}, {static_cast<long>(rows.size())}};
  for (const auto& each : split.counts(whole, results.outputs[0].values)) sum += each[0];
  CHECK(sum == std::ssize(rows));
  CHECK(split.of_row(rows.size() - 1) == 6);
}
