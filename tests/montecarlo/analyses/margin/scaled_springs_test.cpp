#include "montecarlo/analyses/margin/scaled_springs.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <span>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("a scaled campaign has one dispersion more, and the same draws", "[margin]") {
  const Campaign campaign = campaign_of(one_panel_margin(10));
  const Campaign once = scaled(campaign, campaign.margin->scaled, 1.25);
  const Campaign twice = scaled(once, campaign.margin->scaled, 2);
  CHECK(once.dispersions.back().name == "margin_scale");
  CHECK(twice.dispersions.back().name == "margin_scale_2");
  CHECK(read_campaign(twice.resolved.dump(), "").resolved == twice.resolved);
  std::vector<double> draws(3), more(5);
  RunPlan(campaign).draw(7, draws);
  RunPlan(twice).draw(7, more);
  CHECK(std::ranges::equal(draws, std::span(more).first(3)));
  Scene scene = campaign.scene, other = campaign.scene;
  apply(campaign, draws, campaign.scene, scene);
  apply(twice, more, campaign.scene, other);
  CHECK(other.hinges[0].spring.torque_stowed == scene.hinges[0].spring.torque_stowed * 1.25 * 2);
  CHECK(other.hinges[0].friction.coulomb == scene.hinges[0].friction.coulomb);
}
