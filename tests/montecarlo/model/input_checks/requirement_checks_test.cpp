// Where check says that no peak can be proven final, no run of any length has a proof; elsewhere runs have one.
#include "core/deployment.hpp"
#include "montecarlo/model/input_checks/requirement_checks.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

namespace {

Scene one_panel() {
  Scene scene;
  scene.bodies = {{"panel", 10, 0.5}};
  Hinge hinge;
  hinge.name = "root", hinge.child = 0, hinge.child_point = {-0.505, 0.02};
  hinge.stowed = 1.5, hinge.latched = 0, hinge.latch = Latch{1e4, 100};
  hinge.spring.torque_stowed = hinge.spring.torque_latched = 2;
  scene.hinges = {hinge};
  return scene;
}

void check_agrees(const Scene& scene) {
  Integration integration;
  integration.t_end = 200;
  const Outcome outcome = Deployment().run(scene, integration, Goal());
  REQUIRE(outcome.status == Status::deployed);
  CHECK(outcome.peaks_final == why_never_final(scene).empty());
}

} // namespace

TEST_CASE("where no peak can be proven final, none is, and elsewhere they are", "[warnings]") {
  Scene scene = one_panel();
  check_agrees(scene);
  scene.hinges[0].latch->backlash = 0.002;
  CHECK_FALSE(why_never_final(scene).empty());
  check_agrees(scene);
  scene.hinges[0].friction.coulomb = 0.02;
  CHECK_FALSE(why_never_final(scene).empty()); // regularized
  scene.hinges[0].friction.model = FrictionModel::exact;
  check_agrees(scene);

  Scene in_air = one_panel();
  in_air.bodies[0].plate = Plate{{-0.5, 0}, {0.5, 0}, 1, 1.2};
  check_agrees(in_air);
  in_air.environment.air_density = 1.2;
  check_agrees(in_air); // a base that stands
  in_air.environment.gravity = {0, -0.01};
  check_agrees(in_air);
  in_air.base.motion = BaseMotion::prescribed;
  check_agrees(in_air); // without a motion
  in_air.base.rate = 0.01;
  CHECK_FALSE(why_never_final(in_air).empty());
  check_agrees(in_air);
  in_air.base = Base{};
  in_air.base.motion = BaseMotion::free, in_air.base.mass = 100, in_air.base.inertia = 50;
  in_air.environment.gravity = {0, 0};
  CHECK_FALSE(why_never_final(in_air).empty());
  check_agrees(in_air);

  Scene quickening = one_panel();
  quickening.base.motion = BaseMotion::prescribed, quickening.base.angular_acceleration = 1e-4;
  CHECK_FALSE(why_never_final(quickening).empty());
}

TEST_CASE("a limit far from the nominal value: met by every run or by none, by its side",
          "[warnings]") {
  Campaign campaign = test::campaign_of(test::quick_campaign(10));
  const Outcome nominal = Deployment().run(campaign.scene, campaign.integration, {});
  REQUIRE(nominal.status == Status::deployed);
  const double time = nominal.latches.back().time;
  for (const bool is_max : {true, false})
    for (const bool is_far_above : {true, false}) {
      CAPTURE(is_max, is_far_above);
      Requirement requirement;
      requirement.output = "deployment_time";
      (is_max ? requirement.max : requirement.min) = time * (is_far_above ? 1e3 : 1e-3);
      campaign.requirements = {requirement};
      InputWarnings warnings({});
      check_requirements(campaign, nominal, warnings);
      REQUIRE(warnings.list().size() == 1);
      CHECK_THAT(warnings.list()[0].usual,
                 Catch::Contains(is_max == is_far_above ? "every run meets" : "no run meets"));
    }
}

TEST_CASE("a cut peak breaks a max and may meet a min: only the max is warned of", "[warnings]") {
  Campaign campaign = test::campaign_of(test::ringing_panel(10, 6, 2));
  Base& base = campaign.scene.base;
  base.motion = BaseMotion::prescribed, base.angular_acceleration = 1e-5;
  Goal goal;
  const Outcome nominal = Deployment().run(campaign.scene, campaign.integration, goal);
  REQUIRE_FALSE(nominal.peaks_final);
  const auto warned = [&] {
    InputWarnings warnings({});
    check_requirements(campaign, nominal, warnings);
    return warnings.list();
  };
  Requirement& requirement = campaign.requirements.front();
  REQUIRE(warned().size() == 1);
  CHECK_THAT(warned()[0].found, Catch::Contains("faster and faster"));
  requirement.max.reset(), requirement.min = 3;
  CHECK(warned().empty());
  requirement.min = 3000; // its size is checked as elsewhere
  REQUIRE(warned().size() == 1);
  CHECK_THAT(warned()[0].usual, Catch::Contains("no run meets"));
}

TEST_CASE("a draw may be the reason why no peak is final, though the nominal wing has none",
          "[warnings]") {
  Json json = test::ringing_panel(10, 6, 2);
  json["scene"]["base"] = parse_json(R"({ "motion": "prescribed" })");
  const auto why = [&](const char* law) {
    json["dispersions"][0] = parse_json(R"({ "name": "turn", "apply": "set",
      "to": ["base.angular_acceleration"] })");
    json["dispersions"][0]["distribution"] = parse_json(law);
    return why_never_final(test::campaign_of(json));
  };
  CHECK(why(R"({ "type": "constant", "value": 0 })").empty());
  for (const char* law : {R"({ "type": "normal", "mean": 0, "std": 1e-5 })",
                          R"({ "type": "uniform", "lower": 0, "upper": 1e-3 })"}) {
    CAPTURE(law);
    CHECK(why(law) == "with a base that turns faster and faster");
  }
  CHECK(why(R"({ "type": "discrete", "values": [0, 1e-3], "weights": [99, 1] })") ==
        "for runs with a base that turns faster and faster");
}

TEST_CASE("two draws together may be the reason why no peak is final", "[warnings]") {
  Json json = test::ringing_panel(10, 6, 2);
  json["scene"]["hinges"][0]["friction"]["model"] = "exact";
  const auto why = [&](const char* backlash, const char* coulomb) {
    json["dispersions"] = Json::array();
    for (const auto& [path, values] : {std::pair("hinges.root.latch.backlash", backlash),
                                       {"hinges.root.friction.coulomb", coulomb}}) {
      Json law = parse_json(R"({ "apply": "set", "distribution": { "type": "discrete" } })");
      law["name"] = path, law["to"] = {path};
      law["distribution"]["values"] = parse_json(values);
      law["distribution"]["weights"] = {1, 1};
      json["dispersions"].push_back(law);
    }
    return why_never_final(test::campaign_of(json));
  };
  CHECK(why("[0, 0.002]", "[0, 0.02]").starts_with("for runs with backlash in a latch"));
  CHECK(why("[0.001, 0.002]", "[0, 0]").starts_with("with backlash in a latch"));
  CHECK(why("[0, 0.002]", "[0.01, 0.02]").empty());
  CHECK(why("[0, 0]", "[0, 0.02]").empty());
}
