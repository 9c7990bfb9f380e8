#include "montecarlo/engine/accuracy/run_check.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <string>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// The check of the three-panel wing by default settings. @param latch replaces every latch if it is not null
std::optional<RunCheck> check_of(const Json& latch, double t_end = 12) {
  Json scene = parse_json_file(three_panel_file());
  for (Json& hinge : scene["hinges"])
    if (!latch.is_null()) hinge["latch"] = latch;
  Json json = quick_campaign(1);
  json["scene"] = scene;
  const Scene read = campaign_of(json).scene;
  Integration integration;
  integration.t_end = t_end;
  Goal goal;
  goal.to_t_end = true;
  const Outcome own = Deployment().run(read, integration, goal, Observer{});
  return check_run(read, integration, goal, own);
}

const CheckedOutput& output_of(const RunCheck& check, const std::string& name) {
  const auto found = std::ranges::find(check.outputs, name, &CheckedOutput::name);
  REQUIRE(found != check.outputs.end());
  return *found;
}

} // namespace

TEST_CASE("digits that agree", "[accuracy]") {
  CHECK(agreeing_digits(1, 1) == 16);
  CHECK(agreeing_digits(0, 0) == 16);
  CHECK(agreeing_digits(1000, 1001) == 3);
  CHECK(agreeing_digits(-1000, -999.5) == 3);
  CHECK(agreeing_digits(1, 1.2) == 0);
  CHECK(agreeing_digits(1, -1) == 0);
  CHECK(agreeing_digits(0, 1e-300) == 0);
}

TEST_CASE("a run that its tolerance decides agrees with its check in many digits", "[accuracy]") {
  const auto check = check_of(nullptr);
  REQUIRE(check);
  CHECK(check->method == "dopri5");
  CHECK(check->rtol == 1e-10);
  CHECK(check->agrees);
  for (const CheckedOutput& output : check->outputs) {
    CAPTURE(output.name, output.value, output.reference);
    CHECK(output.digits >= 6);
    CHECK_FALSE(output.moved);
  }
}

TEST_CASE("a rattling wing's peaks move by more than 1 %, and its check says so", "[accuracy]") {
  const auto check = check_of({{"stiffness", 1e7}, {"damping", 1.0}, {"backlash", 0.004}});
  REQUIRE(check);
  CHECK(output_of(*check, "root.latch_time").digits >=
        9);      // what comes before the rattling is known
  int moved = 0; // which ones, rounding decides
  for (const CheckedOutput& output : check->outputs) {
    if (output.name.find("peak") == std::string::npos) continue;
    CAPTURE(output.name, output.value, output.reference);
    const double by = std::abs(output.value - output.reference);
    const double most = std::max(std::abs(output.value), std::abs(output.reference));
    if (by > 0.0101 * most) CHECK(output.moved);
    if (by < 0.0099 * most) CHECK_FALSE(output.moved);
    if (output.moved) CHECK(output.digits <= 2);
    moved += output.moved ? 1 : 0;
  }
  CHECK(moved > 0);
}

TEST_CASE("outputs that happen in one of two integrations have moved, those in neither have not",
          "[accuracy]") {
  const auto check = check_of(nullptr, 5.95); // the root latches at 5.94 s in both
  REQUIRE(check);
  CHECK(std::isnan(output_of(*check, "deployment_time").reference));
  CHECK_FALSE(output_of(*check, "deployment_time").moved);
  const Scene scene = campaign_of(quick_campaign(1)).scene;
  Integration integration;
  integration.t_end = 12;
  const Goal goal{.to_t_end = true};
  Outcome own = Deployment().run(scene, integration, goal, Observer{});
  REQUIRE(own.status == Status::deployed);
  own.latches.pop_back(), own.status = Status::timed_out; // as if the last latch had been missed
  const auto other = check_run(scene, integration, goal, own);
  REQUIRE(other);
  const CheckedOutput& time = output_of(*other, "deployment_time");
  CHECK((std::isnan(time.value) && !std::isnan(time.reference)));
  CHECK((time.moved && time.digits == 0));
  CHECK_FALSE(other->agrees);
}

TEST_CASE("a base that only rounding turns has not moved", "[accuracy]") {
  const Scene scene =
      read_scene_file(three_panel_file().parent_path() / "bending_wings.json"); // mirrored
  Integration integration;
  integration.t_end = 8, integration.atol = 1e-18;
  Goal goal;
  goal.to_t_end = true, goal.base_motion = true;
  const Outcome own = Deployment().run(scene, integration, goal, Observer{});
  const auto check = check_run(scene, integration, goal, own);
  REQUIRE(check);
  const CheckedOutput& turn = output_of(*check, "base.peak_rate");
  CHECK(turn.value != turn.reference);
  CHECK(std::abs(turn.value - turn.reference) > integration.atol);
  CHECK_FALSE(turn.moved);
  CHECK(turn.digits == 16);
}

TEST_CASE("a reference that latches in another order, or ends otherwise, does not agree",
          "[accuracy]") {
  const Scene scene = campaign_of(quick_campaign(1)).scene;
  Integration integration;
  integration.t_end = 12;
  Goal goal;
  goal.to_t_end = true;
  const Outcome own = Deployment().run(scene, integration, goal, Observer{});
  REQUIRE(own.latches.size() > 1);
  Outcome reversed = own, late = own;
  std::ranges::reverse(reversed.latches);
  late.status = Status::timed_out;
  const auto agrees = [&](const Outcome& outcome) {
    return check_run(scene, integration, goal, outcome)->agrees;
  };
  CHECK(agrees(own));
  CHECK_FALSE(agrees(reversed));
  CHECK_FALSE(agrees(late));
}
