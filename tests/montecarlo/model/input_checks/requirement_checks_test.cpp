// Where check says that no peak can be proven final, no run of any length has a proof; elsewhere runs have one.
#include "core/deployment.hpp"
#include "montecarlo/model/input_checks/requirement_checks.hpp"
#include "tests/montecarlo/campaign_support.hpp"
#include "tests/support/random_cases.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <map>

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

TEST_CASE("where nothing holds a hinge no peak is final, unless nothing drives it off either",
          "[warnings]") {
  Scene scene = one_panel();
  scene.bodies.push_back({"boom", 1, 0.05});
  Hinge pivot = scene.hinges[0];
  pivot.name = "pivot", pivot.parent = 0, pivot.child = 1, pivot.latch.reset();
  pivot.parent_point = {0.5, 0}, pivot.child_point = {0, 0};
  pivot.spring.torque_stowed = pivot.spring.torque_latched = 0.01;
  scene.hinges.push_back(pivot);
  CHECK(why_never_final(scene) == "with a hinge that nothing holds");
  check_agrees(scene);
  Hinge& boom = scene.hinges[1];
  boom.spring.torque_stowed = boom.spring.torque_latched = 0;
  CHECK(why_never_final(scene).empty()); // moments and forces are bounded
  scene.environment.gravity = {0.1, 0};
  CHECK_FALSE(why_never_final(scene).empty());
  scene.environment.gravity = {0, 0};
  boom.spring.torque_stowed = 0.01; // 0 at the latched angle: a stiffness
  boom.friction.viscous = 0.05;
  check_agrees(scene);
  CHECK(why_never_final(scene).empty());
  boom.latch = Latch{0, 1}; // of no stiffness, under a spring that grows
  boom.spring.torque_stowed = 0.01, boom.spring.torque_latched = 0.02;
  check_agrees(scene);
  CHECK_FALSE(why_never_final(scene).empty());
  for (Hinge& hinge : scene.hinges)
    hinge.friction.model = FrictionModel::exact, hinge.friction.static_level = 0.03;
  CHECK(why_never_final(scene).empty());
  for (Hinge& hinge : scene.hinges) hinge.friction.scale = 0;
  CHECK_FALSE(why_never_final(scene).empty());
}

TEST_CASE("on a base that is pushed and turns, without any damping, no peak is final",
          "[warnings]") {
  Scene scene = one_panel();
  scene.base.motion = BaseMotion::prescribed, scene.base.rate = 0.01;
  scene.hinges[0].latch->damping = 0;
  CHECK(why_never_final(scene).empty());
  scene.base.acceleration = {1e-3, 0};
  CHECK(why_never_final(scene) ==
        "with latches without damping on a base that is pushed and turns");
  check_agrees(scene);
  scene.environment.gravity = {1e-3, 0}; // the base falls: no load
  CHECK(why_never_final(scene).empty());
  scene.base.acceleration = {0, 0};
  check_agrees(scene);
  scene.hinges[0].friction.viscous = 1;
  CHECK(why_never_final(scene).empty());
  scene.base.rate = 0;
  scene.hinges[0].friction.viscous = 0;
  CHECK(why_never_final(scene).empty());
}

TEST_CASE("no run of a random wing with a reason has a peak that is proven final", "[warnings]") {
  int finals = 0, cut = 0;
  std::map<std::string_view, int> reasons;
  for (int seed = 1; seed <= random_cases(1000, 200); ++seed) {
    oracle::Draws draws(seed);
    const auto one_of = [&](std::initializer_list<double> values) {
      return values.begin()[draws.below(static_cast<int>(values.size()))];
    };
    Scene scene = one_panel();
    scene.base.motion = static_cast<BaseMotion>(seed % 3);
    scene.base.mass = 100, scene.base.inertia = 50;
    scene.base.rate = one_of({0, 0.05}), scene.base.acceleration = {one_of({0, 0.01}), 0};
    scene.environment.gravity = {0, one_of({0, 0, 0.02})};
    scene.bodies.push_back({"tip", 2, 0.1});
    Hinge tip = scene.hinges[0];
    tip.name = "tip", tip.parent = 0, tip.child = 1, tip.parent_point = {0.5, 0};
    tip.child_point = {-0.2, 0};
    tip.spring.torque_latched = one_of({0, 0.5, 0.5, 1});
    tip.spring.torque_stowed = one_of({tip.spring.torque_latched, 0.75});
    scene.hinges.push_back(tip);
    const double damping = one_of({0, 1}); // of all hinges
    for (Hinge& hinge : scene.hinges) {
      hinge.latch->damping = one_of({0, damping * 50});
      hinge.friction.viscous = one_of({0, damping * 0.2});
      hinge.friction.model =
          one_of({0, 1}) == 0 ? FrictionModel::regularized : FrictionModel::exact;
      hinge.friction.coulomb = one_of({0, 0.05});
    }
    if (one_of({0, 0, 1}) == 1) scene.hinges[1].latch.reset();
    Integration integration;
    integration.t_end = 40;
    const Outcome outcome = Deployment().run(scene, integration, Goal());
    const std::string_view why = why_never_final(scene);
    CAPTURE(seed, why);
    if (outcome.status != Status::deployed) continue;
    if (why.empty()) {
      ++(outcome.peaks_final ? finals : cut);
      continue;
    }
    ++reasons[why];
    CHECK_FALSE((outcome.peaks_final || outcome.moments_final || outcome.forces_final));
  }
  CAPTURE(finals, cut);
  CHECK(finals > 30);
  CHECK(reasons.size() == 2);
  for (const auto& [why, runs] : reasons) CHECK(runs >= 5);
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
  for (const char* law :
       {R"({ "type": "discrete", "values": [0, 1e-3], "weights": [99, 1] })",
        R"({ "type": "discrete", "values": [1e-3, 0], "weights": [1e-8, 1] })", // however rare
        R"({ "type": "discrete", "values": [-1e-3, 0, 1e-3], "weights": [1, 1, 1] })"}) {
    CAPTURE(law);
    CHECK(why(law) == "for runs with a base that turns faster and faster");
  }
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
