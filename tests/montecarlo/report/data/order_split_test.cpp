#include "montecarlo/report/data/order_split.hpp"
#include "tests/montecarlo/report/data/page_support.hpp"

#include <catch2/catch.hpp>

#include <tuple>

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
  const OrderSplit split(results);
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

// α and γ begin with the same byte as β and δ.
TEST_CASE("names of wings and hinges keep whole characters", "[page]") {
  Scene scene;
  scene.bodies.resize(4);
  for (const auto& [name, parent, child] :
       {std::tuple("α", base_index, 0), std::tuple("β", 0, 1), std::tuple("xγ", base_index, 2),
        std::tuple("xδ", 2, 3)}) {
    Hinge hinge;
    hinge.name = name, hinge.parent = parent, hinge.child = child;
    scene.hinges.push_back(hinge);
  }
  const Results results = rows_with({{"α>xγ>β>xδ", 0}});
  CHECK(OrderSplit(results, scene).groups()[0].name == "α: α>β · x: γ>δ");
}

TEST_CASE("each wing has its own orders, by hand", "[page]") {
  Scene scene;
  scene.bodies.resize(4);
  for (const auto& [name, parent, child] :
       {std::tuple("left_root", base_index, 0), std::tuple("left_tip", 0, 1),
        std::tuple("right_root", base_index, 2), std::tuple("right_tip", 2, 3)}) {
    Hinge hinge;
    hinge.name = name;
    hinge.parent = parent;
    hinge.child = child;
    scene.hinges.push_back(hinge);
  }
  const Results results = rows_with({{"left_root>right_root>left_tip>right_tip", 0},
                                     {"right_root>left_root>left_tip>right_tip", 0},
                                     {"right_tip>right_root>left_tip", 0},
                                     {"left_root", 0},
                                     {"", 0}});
  const std::vector<WingOrders> wings = wing_orders(order_counts(results), scene);
  REQUIRE(wings.size() == 2);
  CHECK(wings[0].name == "left");
  CHECK(wings[1].name == "right");
  CHECK(wings[1].hinges == std::vector<std::string>{"right_root", "right_tip"});
  REQUIRE(wings[0].orders.size() == 3);
  CHECK((wings[0].orders[0].name == "left_root>left_tip" && wings[0].orders[0].count == 2));
  CHECK(wings[0].without == 1);
  REQUIRE(wings[1].orders.size() == 2);
  CHECK((wings[1].orders[0].name == "right_root>right_tip" && wings[1].orders[0].count == 2));
  CHECK(wings[1].without == 2);
  const OrderSplit split(results, scene);
  CHECK(split.kinds() == 3);
  REQUIRE(split.groups().size() == 4);
  CHECK(split.groups()[0].name == "left: root>tip · right: root>tip");
  CHECK(split.groups()[0].count == 2);
  CHECK(split.groups()[1].name == "left: root · right: none");
  CHECK(split.groups()[2].name == "left: tip · right: tip>root");
  CHECK(split.groups()[3].name == "no latch");
  CHECK((split.of_row(1) == 0 && split.of_row(3) == 1 && split.of_row(4) == 3));
  scene.hinges[2].parent = 1; // one wing
  CHECK(wing_orders(order_counts(results), scene).empty());
}

TEST_CASE("orders beyond the six most frequent stand together", "[page]") {
  std::vector<std::pair<std::string, double>> rows;
  for (int order = 0; order < 9; ++order)
    for (int k = 0; k < 10 - order; ++k)
      rows.emplace_back(std::string(1, char('a' + order)), order);
  const Results results = rows_with(rows);
  const OrderSplit split(results);
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

TEST_CASE("gaps between the latches of an order", "[page]") {
  Results results(ResultNames{{}, {"root.latch_time", "mid.latch_time", "tip.latch_time"}});
  const auto add = [&](std::vector<double> times, const char* order) {
    results.append(
        {static_cast<long>(results.size()), Status::deployed, {}, std::move(times), order, ""});
  };
  add({1, 1.5, 4}, "root>mid>tip");
  add({2, 2.2, 3}, "root>mid>tip");
  add({1, 1.9, 2}, "root>mid>tip");
  add({5, 4, 6}, "mid>root>tip");
  const auto gaps = latch_gaps(results, {"root", "mid", "tip"}, "root>mid>tip");
  REQUIRE(gaps.size() == 2);
  CHECK(gaps[0].before == "root");
  CHECK(gaps[0].after == "mid");
  CHECK(gaps[0].least == Approx(0.2));
  CHECK(gaps[0].median == Approx(0.5));
  CHECK(gaps[1].least == Approx(0.1));
  CHECK(gaps[1].median == Approx(0.8));
  // of some of the hinges: the order among these, in every run
  const auto ends = latch_gaps(results, {"root", "tip"}, "root>tip");
  REQUIRE(ends.size() == 1);
  CHECK(ends[0].least == Approx(1));
  CHECK(latch_gaps(results, {"root"}, "root").empty());
  CHECK(latch_gaps(results, {"root", "other"}, "root>other").empty());
}
