// Which parts of an outcome's text and JSON a run or a hinge has.
#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/report/text/outcome_report.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

Outcome to_20_s(const Scene& scene) {
  Integration integration;
  integration.t_end = 20;
  Goal goal;
  goal.to_t_end = true;
  return Deployment().run(scene, integration, goal);
}

} // namespace

TEST_CASE("a run that did not begin has its reason, and no tables") {
  const Scene scene = read_scene_file(three_panel_file());
  for (const Status status : {Status::failed, Status::invalid}) {
    Outcome outcome;
    outcome.status = status, outcome.reason = "what it needs is not there";
    const std::string text = outcome_text(scene, outcome);
    CHECK(text.find(outcome.reason) != std::string::npos);
    CHECK(text.find("END") == std::string::npos);
    CHECK(outcome_json(scene, outcome)["reason"] == outcome.reason);
  }
}

TEST_CASE("an elastic joint has loads, and neither overtravel nor a final angle of its own") {
  Scene scene = read_scene_file(three_panel_file());
  scene.hinges[2].joint = Joint{500, 1};
  scene.hinges[2].latch.reset(), scene.hinges[2].spring = {}, scene.hinges[2].friction = {};
  scene.hinges[2].stowed = scene.hinges[2].latched = 0;
  const Json json = outcome_json(scene, to_20_s(scene));
  for (const char* key : {"overtravel", "final_angle"}) {
    CAPTURE(key);
    REQUIRE(json[key].is_object());
    CHECK(json[key].contains(scene.hinges[0].name));
    CHECK_FALSE(json[key].contains(scene.hinges[2].name));
  }
  CHECK(json["peak_moment"].contains(scene.hinges[2].name));
}
