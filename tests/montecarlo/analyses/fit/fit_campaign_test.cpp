#include "montecarlo/analyses/fit/fit_campaign.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

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
