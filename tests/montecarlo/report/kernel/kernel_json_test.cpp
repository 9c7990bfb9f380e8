#include "core/scene/segments.hpp"
#include "core/scene/torque.hpp"
#include "montecarlo/engine/runs/run_plan.hpp"
#include "montecarlo/model/campaign/distribution_json.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "montecarlo/model/schema/schema.hpp"
#include "montecarlo/report/kernel/campaign_numbers.hpp"
#include "montecarlo/report/kernel/kernel_json.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <deque>
#include <set>
#include <variant>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// Reads numbers as the kernel in the page does.
class NumbersIn {
public:
  static constexpr bool reads = true;
  explicit NumbersIn(const Json& json) {
    for (const Json& each : json)
      numbers_.push_back(each.is_number()     ? each.get<double>()
                         : each == "Infinity" ? std::numeric_limits<double>::infinity()
                                              : -std::numeric_limits<double>::infinity());
  }
  void number(double& value) {
    places.push_back(&value);
    value = next();
  }
  void integer(int& value) { value = static_cast<int>(next()); }
  void list(std::vector<double>& values) {
    values.resize(static_cast<std::size_t>(next()));
    for (double& value : values) value = next();
  }
  void text(std::string& text) {
    std::vector<double> bytes;
    list(bytes);
    text.clear();
    for (const double byte : bytes) text += static_cast<char>(byte);
  }
  [[nodiscard]] bool at_end() const { return numbers_.empty(); }
  std::vector<double*> places;

private:
  double next() {
    const double value = numbers_.at(0);
    numbers_.pop_front();
    return value;
  }
  std::deque<double> numbers_;
};

/// A scene with the names of another, which the numbers do not hold.
Scene named_like(Scene scene, const Scene& names) {
  scene.name = names.name;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) scene.bodies[i].name = names.bodies[i].name;
  for (std::size_t i = 0; i < scene.hinges.size(); ++i) scene.hinges[i].name = names.hinges[i].name;
  for (std::size_t i = 0; i < scene.synchronisations.size(); ++i)
    scene.synchronisations[i].name = names.synchronisations[i].name;
  return scene;
}

} // namespace

TEST_CASE("the kernel's numbers hold every part of a scene", "[page]") {
  long campaigns = 0;
  for (const Json& specimen : campaign_specimens()) {
    Json json = specimen;
    if (json["scene"].is_string() || json.dump().find("no_such_file") != std::string::npos)
      continue;
    CAPTURE(json.dump());
    const Campaign campaign = campaign_of(json);
    const Json kernel = kernel_json(campaign);
    const auto of_rows = [](const Dispersion& dispersion) { return !dispersion.rows.empty(); };
    if (has_flexible_bodies(campaign.scene) || std::ranges::any_of(campaign.dispersions, of_rows)) {
      CHECK(kernel.is_null());
      continue;
    }
    NumbersIn reading(kernel["numbers"]);
    NumberedCampaign read;
    CampaignNumbers<NumbersIn> visit(reading);
    visit.scene(read.scene);
    visit.rest(read);
    CHECK(reading.at_end());
    CHECK(write_scene(named_like(read.scene, campaign.scene)) == write_scene(campaign.scene));
    CHECK(read.design.seed == campaign.sampling.seed);
    CHECK(read.integration.method == campaign.integration.method);
    CHECK(read.integration.t_end == campaign.integration.t_end);
    REQUIRE(read.dispersions.size() == campaign.dispersions.size());
    for (std::size_t i = 0; i < read.dispersions.size(); ++i) {
      CHECK(read.dispersions[i].name == campaign.dispersions[i].name);
      CHECK(write_distribution(read.dispersions[i].distribution) ==
            write_distribution(campaign.dispersions[i].distribution));
    }
    ++campaigns;
  }
  CHECK(campaigns > 3);
}

TEST_CASE("the kernel's numbers hold every law, with the ends of its truncation", "[page]") {
  std::set<std::size_t> laws;
  long open_below = 0, open_above = 0;
  for (const Json& specimen : campaign_specimens()) {
    Json json{{"scene", scene_specimens().front()}, {"dispersions", Json::array()}};
    for (const Json& each : specimen.value("dispersions", Json::array()))
      if (!each.contains("rows") && each.dump().find("no_such_file") == std::string::npos)
        json["dispersions"].push_back(each);
    const Campaign campaign = campaign_of(json);
    NumbersIn reading(kernel_json(campaign)["numbers"]);
    NumberedCampaign read;
    CampaignNumbers<NumbersIn> visit(reading);
    visit.scene(read.scene), visit.rest(read);
    REQUIRE(read.dispersions.size() == campaign.dispersions.size());
    for (std::size_t i = 0; i < read.dispersions.size(); ++i) {
      const Distribution &found = read.dispersions[i].distribution,
                         &expected = campaign.dispersions[i].distribution;
      CAPTURE(campaign.dispersions[i].name);
      CHECK(write_distribution(found) == write_distribution(expected));
      laws.insert(expected.law.index());
      REQUIRE(found.truncate.has_value() == expected.truncate.has_value());
      if (!expected.truncate) continue;
      CHECK(found.truncate->lower == expected.truncate->lower); // infinite where there is none
      CHECK(found.truncate->upper == expected.truncate->upper);
      open_below += std::isinf(expected.truncate->lower);
      open_above += std::isinf(expected.truncate->upper);
    }
  }
  CHECK(laws.size() == std::variant_size_v<Law>);
  CHECK((open_below > 0 && open_above > 0));
}

TEST_CASE("the kernel's runs have the goal of the campaign's, whatever the outputs", "[page]") {
  for (const OutputFamilyInfo& family : output_families) {
    CAPTURE(family.name);
    Json json = quick_campaign(5);
    json["scene"]["base"] = {{"motion", "free"}, {"mass", 500}, {"inertia", 300}};
    json["outputs"] = {family.name};
    const Campaign campaign = campaign_of(json);
    NumbersIn reading(kernel_json(campaign)["numbers"]);
    NumberedCampaign read;
    CampaignNumbers<NumbersIn> visit(reading);
    visit.scene(read.scene), visit.rest(read);
    const Goal own = goal_of(campaign.outputs);
    for (bool Goal::*flag :
         {&Goal::peak_moment, &Goal::peak_force, &Goal::overtravel, &Goal::hold_moment,
          &Goal::base_motion, &Goal::motor_energy, &Goal::final_angle, &Goal::to_rest})
      CHECK(read.goal.*flag == own.*flag);
  }
}

TEST_CASE("the kernel's effects change the scene as a run's draws do", "[page]") {
  Json specimen = campaign_specimens().front();
  std::erase_if(specimen["dispersions"].get_ref<Json::array_t&>(),
                [](const Json& dispersion) { return dispersion.contains("rows"); });
  for (const Json& json : {full_campaign(20), specimen}) {
    const Campaign campaign = campaign_of(json);
    NumbersIn reading(kernel_json(campaign)["numbers"]);
    NumberedCampaign read;
    CampaignNumbers<NumbersIn> visit(reading);
    visit.scene(read.scene);
    const std::vector<double*> places = reading.places;
    visit.rest(read);
    const RunPlan plan(campaign);
    std::vector<double> draws(campaign.dispersions.size());
    plan.draw(3, draws);
    Scene scene = campaign.scene;
    apply(campaign, draws, campaign.scene, scene);
    for (std::size_t i = 0; i < draws.size(); ++i)
      for (const NumberedEffect& effect : read.dispersions[i].effects) {
        const double by =
            effect.at.empty()
                ? draws[i]
                : Curve(effect.at, effect.value, Interpolation::monotone).value_at(draws[i]);
        double& number = *places.at(static_cast<std::size_t>(effect.place));
        number = effect.how == 0 ? by : effect.how == 1 ? number * by : number + by;
      }
    CHECK(write_scene(named_like(read.scene, scene)) == write_scene(scene));
  }
}

TEST_CASE("each slider's place is the number that it says, of its own hinge", "[page]") {
  for (Json scene : {real_scene(), small_scene(), parse_json_file(three_panel_file())}) {
    Json json = quick_campaign(3);
    json["scene"] = scene;
    json["dispersions"] = Json::array();
    const Campaign campaign = campaign_of(json);
    const Json kernel = kernel_json(campaign);
    NumbersIn reading(kernel["numbers"]);
    NumberedCampaign read;
    CampaignNumbers<NumbersIn> visit(reading);
    visit.scene(read.scene);
    REQUIRE(kernel["hinges"].size() == read.scene.hinges.size());
    for (std::size_t h = 0; h < read.scene.hinges.size(); ++h) {
      Hinge& hinge = read.scene.hinges[h];
      const auto is_at = [&](const char* slider, const double* number) {
        const Json& place = kernel["hinges"][h][slider];
        CAPTURE(h, slider);
        REQUIRE(place.is_null() == (number == nullptr));
        if (number) CHECK(reading.places.at(place.get<std::size_t>()) == number);
      };
      is_at("spring", &hinge.spring.scale);
      is_at("friction", &hinge.friction.scale);
      is_at("damper", hinge.damper ? &hinge.damper->scale : nullptr);
      is_at("latch", hinge.latch ? &hinge.latch->stiffness : nullptr);
    }
  }
}
