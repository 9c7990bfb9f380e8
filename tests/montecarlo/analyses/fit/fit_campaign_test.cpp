#include "montecarlo/analyses/fit/fit_campaign.hpp"
#include "montecarlo/analyses/fit/fit_spec.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("fitted dispersions become columns with their effects, others stay as they are") {
  const Folder folder;
  Json json = quick_campaign(4);
  json["dispersions"].push_back(parse_json(R"({ "name": "cause",
    "distribution": { "type": "normal", "mean": 20, "std": 5 },
    "through": [ { "to": ["hinges.*.friction.scale"], "apply": "scale",
                   "table": { "at": [0, 40], "value": [1, 0.9] } } ] })"));
  json["correlations"] = parse_json(R"([ { "between": ["root_spring", "cause"], "spearman": 0.5 },
    { "between": ["mass.panel_1", "mass.panel_3"], "spearman": 0.2 } ])");
  json["cases"] = parse_json(R"([ { "name": "cold", "distributions": {
    "cause": { "type": "normal", "mean": -20, "std": 5 } } } ])");
  json["sampling"]["extended_from"] = {2};
  const Campaign campaign = campaign_of(json);
  REQUIRE(campaign.dispersions.size() == 5);
  const std::vector<std::size_t> fitted{0, 2, 4}; // root_spring, mass.panel_2, cause
  folder.write(posterior_file, "root_spring,mass.panel_2,cause\n1.1,10,30\n1.1,10,30\n");
  const Campaign after = read_campaign(predicting_campaign(campaign, fitted).dump(), folder.path());
  std::vector<std::string> names, own;
  for (const Dispersion& dispersion : after.dispersions)
    (dispersion.rows.empty() ? own : names).push_back(dispersion.name);
  CHECK(names == std::vector<std::string>{"root_spring", "mass.panel_2", "cause"});
  CHECK(own == std::vector<std::string>{"mass.panel_1", "mass.panel_3"});
  REQUIRE(after.wanted_correlations.size() == 1);
  CHECK(lost_laws(campaign, fitted) == std::vector<std::string>{"cold: cause"});
  CHECK(after.cases.at(0).distributions.empty());
  CHECK(campaign.sampling.extended_from.size() == 1);
  CHECK(after.sampling.extended_from.empty()); // the new laws were not analysed before
  // The effects: both campaigns with the same draws make the same scene.
  const auto draw_of = [](const std::string& name) {
    return name == "cause" ? 30 : name == "root_spring" ? 1.1 : 10.0;
  };
  Scene one = campaign.scene, other = after.scene;
  std::vector<double> draws, draws_after;
  for (const Dispersion& dispersion : campaign.dispersions)
    draws.push_back(draw_of(dispersion.name));
  for (const Dispersion& dispersion : after.dispersions)
    draws_after.push_back(draw_of(dispersion.name));
  apply(campaign, draws, campaign.scene, one);
  apply(after, draws_after, after.scene, other);
  for (const std::string& path : parameter_paths(campaign.scene)) {
    const SceneParameter parameter = resolve(campaign.scene, path).matches.front().parameter;
    CHECK(parameter.in(std::as_const(one)) == parameter.in(std::as_const(other)));
  }
}

TEST_CASE("a case keeps its laws of what is not fitted, whatever their names begin with") {
  const std::vector<std::string> names{"a", "ab", "a_b", "b"};
  Json json = quick_campaign(4);
  json["dispersions"] = Json::array();
  Json laws = Json::object();
  for (const std::string& name : names) {
    json["dispersions"].push_back(
        {{"name", name},
         {"distribution", {{"type", "normal"}, {"mean", 0}, {"std", 0.1}}},
         {"apply", "add"},
         {"to", {"hinges.root.spring.torque_stowed"}}});
    laws[name] = {{"type", "normal"}, {"mean", 0.2}, {"std", 0.3}};
  }
  json["cases"] = {{{"name", "hot"}, {"distributions", laws}}};
  const Campaign campaign = campaign_of(json);
  for (unsigned set = 1; set < 16; ++set) {
    std::vector<std::size_t> fitted;
    std::vector<std::string> kept, lost;
    for (std::size_t i = 0; i < names.size(); ++i)
      if ((set >> i & 1) != 0)
        fitted.push_back(i), lost.push_back("hot: " + names[i]);
      else
        kept.push_back(names[i]);
    CAPTURE(set);
    CHECK(lost_laws(campaign, fitted) == lost);
    std::vector<std::string> found;
    const Json written = predicting_campaign(campaign, fitted);
    for (const auto& [name, law] : written["cases"][0]["distributions"].items())
      found.push_back(name);
    CHECK(found == kept);
  }
}

namespace {

/// Draws that scale and add to a spring's offset in turn, and one that scales a mass.
Campaign changes_in_turn() {
  Json json = quick_campaign(4);
  json["dispersions"] = Json::array();
  const auto add = [&](const char* name, const char* apply, const char* path) {
    json["dispersions"].push_back(
        {{"name", name},
         {"distribution", {{"type", "normal"}, {"mean", 1.5}, {"std", 0.1}}},
         {"apply", apply},
         {"to", {path}}});
  };
  constexpr const char* offset = "hinges.root.spring.offset";
  add("a", "add", offset), add("s", "scale", offset), add("m", "scale", "bodies.panel_1.mass");
  add("b", "add", offset), add("t", "scale", offset), add("c", "add", offset);
  return campaign_of(json);
}

/// The offset, if the fitted draws act together before the other draw with this place.
double offset_with(const std::vector<bool>& fitted, std::size_t place,
                   const std::vector<double>& draws) {
  double offset = 0;
  const auto act = [&](std::size_t i) {
    if (i == 0 || i == 3 || i == 5) offset += draws[i];
    if (i == 1 || i == 4) offset *= draws[i];
  };
  const auto act_fitted = [&] {
    for (std::size_t i = 0; i < draws.size(); ++i)
      if (fitted[i]) act(i);
  };
  std::size_t others = 0;
  for (std::size_t i = 0; i < draws.size(); ++i) {
    if (fitted[i]) continue;
    if (others++ == place) act_fitted();
    act(i);
  }
  if (place >= others) act_fitted();
  return offset;
}

} // namespace

// By trial of all places: the written campaign gives the same wing, or the fit is refused before its runs.
TEST_CASE("fitted draws act in their order among the others, or the fit is refused") {
  const Folder folder;
  const Campaign campaign = changes_in_turn();
  const std::vector<double> draws{1.1, 1.3, 1.2, 0.7, 1.7, 0.4};
  Scene expected = campaign.scene;
  apply(campaign, draws, campaign.scene, expected);
  const double offset = expected.hinges[0].spring.offset;
  int refused = 0;
  for (unsigned set = 1; set < 64; ++set) {
    CAPTURE(set);
    Json names = Json::array();
    std::string header, row;
    std::vector<bool> fitted;
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < draws.size(); ++i)
      if (fitted.push_back((set >> i & 1) != 0); fitted.back()) {
        names.push_back(campaign.dispersions[i].name), indices.push_back(i);
        header += "," + campaign.dispersions[i].name, row += "," + csv_cell(draws[i]);
      }
    bool any = false; // place that keeps the offset
    for (std::size_t place = 0; place <= draws.size(); ++place)
      any = any || offset_with(fitted, place, draws) == Approx(offset).epsilon(1e-12);
    const Json tests{{"tests",
                      {{{"name", "one"},
                        {"values", {{{"output", "deployment_time"}, {"value", 3}, {"std", 1}}}}}}},
                     {"fit", {{"parameters", names}}}};
    const ParameterSpace space(campaign, read_fit(tests, "t.json", ".", campaign));
    const std::string problem = message_of([&] { refuse_lost_order(campaign, space, "t.json"); });
    CHECK(problem.empty() == any);
    refused += !problem.empty();
    if (!problem.empty()) {
      CHECK_THAT(problem, Catch::Contains("t.json: /fit/parameters: "));
      continue;
    }
    folder.write(posterior_file, header.substr(1) + "\n" + row.substr(1) + "\n" + row.substr(1));
    const Campaign after =
        read_campaign(predicting_campaign(campaign, indices).dump(), folder.path());
    std::vector<double> drawn;
    for (const Dispersion& each : after.dispersions)
      drawn.push_back(draws[static_cast<std::size_t>(
          std::ranges::find(campaign.dispersions, each.name, &Dispersion::name) -
          campaign.dispersions.begin())]);
    Scene made = after.scene;
    apply(after, drawn, after.scene, made);
    CHECK(made.hinges[0].spring.offset == Approx(offset).epsilon(1e-12));
    CHECK(made.bodies[0].mass == expected.bodies[0].mass);
  }
  CHECK(refused > 10);
}

TEST_CASE("correlations and laws of what is not fitted stay, whatever fitted names begin with") {
  Json json = quick_campaign(4);
  const Json law = {{"type", "normal"}, {"mean", 1}, {"std", 0.1}};
  json["dispersions"] = {{{"name", "spring"},
                          {"distribution", law},
                          {"apply", "scale"},
                          {"to", {"hinges.root.spring.scale"}}},
                         {{"name", "spring.x"},
                          {"distribution", law},
                          {"apply", "scale"},
                          {"to", {"bodies.panel_1.mass"}}},
                         {{"name", "mass"},
                          {"distribution", law},
                          {"apply", "scale"},
                          {"to", {"bodies.panel_2.mass"}}},
                         {{"name", "rub"},
                          {"distribution", law},
                          {"apply", "scale"},
                          {"each", "hinges.*.friction.scale"}}};
  json["correlations"] = {{{"between", {"spring", "mass"}}, {"spearman", 0.8}}};
  json["cases"] = {{{"name", "cold"}, {"distributions", {{"spring", law}, {"rub", law}}}}};
  const Campaign campaign = campaign_of(json);
  REQUIRE(campaign.dispersions.size() > 4);
  const Json written = predicting_campaign(campaign, {1, 3}); // spring.x, one of rub's copies
  CHECK(written["correlations"].size() == 1);
  const Json& laws = written["cases"][0]["distributions"];
  CHECK(laws.contains("spring"));
  CHECK_FALSE(laws.contains("rub"));
  CHECK_FALSE(laws.contains(campaign.dispersions[3].name));
  for (std::size_t i = 4; i < campaign.dispersions.size(); ++i)
    CHECK(laws.contains(campaign.dispersions[i].name)); // copies that became dispersions
  CHECK(lost_laws(campaign, {1, 3}) ==
        std::vector<std::string>{"cold: " + campaign.dispersions[3].name});
}
