#include "montecarlo/results/results_folder/row_check.hpp"

#include <catch2/catch.hpp>

#include <limits>

using namespace wingspread;

namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();
const ResultNames columns_to_check{
    {},
    {"root.latch_time", "tip.latch_time", "root.peak_moment", "tip.latch_rate", "deployment_time"}};

/// "column: found" of a row's fault; empty without one.
std::string fault_of(Status status, const std::vector<double>& outputs, const std::string& order,
                     const RowRules& rules = {}) {
  ResultRow row;
  row.status = status, row.outputs = outputs, row.latch_order = order;
  const auto fault = RowCheck(columns_to_check, rules).fault_in(row);
  return fault ? fault->column + ": " + fault->found : "";
}

} // namespace

TEST_CASE("rows that do not contradict themselves have no fault") {
  CHECK(fault_of(Status::deployed, {1, 2, 5, -3, 2}, "root>tip") == "");
  CHECK(fault_of(Status::deployed, {2, 2, 5, -3, 2}, "tip>root") == "");
  CHECK(fault_of(Status::deployed, {2, 1, 0, -3, 2}, "") == ""); // another tool knows no order
  CHECK(fault_of(Status::stalled, {1, missing, 5, missing, missing}, "root") == "");
  CHECK(fault_of(Status::timed_out, {1, 2, 5, missing, missing}, "root>tip") ==
        ""); // a hold held a hinge
  CHECK(fault_of(Status::invalid, {missing, missing, missing, missing, missing}, "") == "");
}

TEST_CASE("a row that contradicts itself has a fault, in its column") {
  CHECK(fault_of(Status::deployed, {1, missing, 5, 0, 1}, "root") ==
        "tip.latch_time: nothing in a deployed run");
  CHECK(fault_of(Status::deployed, {1, 2, 5, 0, missing}, "root>tip") ==
        "deployment_time: nothing in a deployed run");
  CHECK(fault_of(Status::deployed, {1, 2, 5, 0, 1.5}, "root>tip") ==
        "deployment_time: 1.5 s, before tip latched");
  CHECK(fault_of(Status::timed_out, {1, missing, 5, 0, 1}, "root") ==
        "deployment_time: 1 s in a run that is timed_out");
  CHECK(fault_of(Status::deployed, {1, 2, 5, 0, 2}, "root>top") ==
        "latch_order: 'root>top', in which no hinge with a latch is named 'top'");
  CHECK(fault_of(Status::deployed, {1, 2, 5, 0, 2}, "root>root") ==
        "latch_order: 'root>root', with 'root' more than once");
  CHECK(fault_of(Status::stalled, {1, missing, 5, 0, missing}, "root>tip") ==
        "latch_order: 'root>tip', but tip.latch_time is empty");
  CHECK(fault_of(Status::deployed, {1, 2, 5, 0, 2}, "tip>root") ==
        "latch_order: 'tip>root', but root latched earlier, at 1 s");
  CHECK(fault_of(Status::deployed, {1, 2, -5, 0, 2}, "root>tip") == "root.peak_moment: -5");
  CHECK(fault_of(Status::deployed, {-1, 2, 5, 0, 2}, "root>tip") == "root.latch_time: -1");
}

TEST_CASE("times beyond t_end are a fault, and t_end itself is none") {
  const RowRules rules{.t_end = 2};
  CHECK(fault_of(Status::deployed, {1, 2, 5, -3, 2}, "root>tip", rules) == "");
  CHECK(fault_of(Status::deployed, {1, 2.5, 5, -3, 2.5}, "root>tip", rules) ==
        "tip.latch_time: 2.5 s");
  CHECK(fault_of(Status::stalled, {300, missing, 5, -3, missing}, "root", rules) ==
        "root.latch_time: 300 s");
}

TEST_CASE("where every hinge latched and no hold holds one, the run is deployed") {
  for (const Status status : {Status::stalled, Status::timed_out})
    for (const char* order : {"", "root>tip"}) {
      CAPTURE(to_string(status), order);
      const std::vector<double> all{1, 2, 5, -3, missing}, one{1, missing, 5, -3, missing};
      CHECK(fault_of(status, all, order, {.holds = true}) == "");
      CHECK(fault_of(status, all, order, {.holds = false}).starts_with("status: "));
      CHECK(fault_of(status, one, *order ? "root" : "", {.holds = false}) == "");
    }
  CHECK(fault_of(Status::failed, {1, 2, 5, -3, missing}, "root>tip", {.holds = false}) == "");
}

TEST_CASE("an order has every hinge that latched, or is empty") {
  CHECK(fault_of(Status::deployed, {1, 2, 5, -3, 2}, "root") ==
        "latch_order: 'root', without tip, which latched at 2 s");
  CHECK(fault_of(Status::stalled, {1, missing, 5, -3, missing}, "") == "");
}
