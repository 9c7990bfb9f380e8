#include "montecarlo/model/static_margins/required_margin.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("a margin of every hinge is the least of the hinges', whichever is the weakest",
          "[motorization]") {
  Scene scene = campaign_of(quick_campaign(1)).scene;
  scene.synchronisations.clear(); // each hinge is a drive of its own
  for (Hinge& hinge : scene.hinges) hinge.friction.coulomb = 0.1; // else nothing resists
  const StaticMarginSpec spec = default_static_margins(scene);
  for (std::size_t weakest = 0; weakest < scene.hinges.size(); ++weakest)
    for (const MarginKind kind : {MarginKind::ecss, MarginKind::nasa, MarginKind::gevs}) {
      Scene weak = scene;
      weak.hinges[weakest].spring.scale = 0.01;
      const auto margin = [&](const std::string& hinge) {
        return least_margin(weak, required_drives(weak, {kind, hinge}), kind, spec);
      };
      double least = std::numeric_limits<double>::infinity();
      for (const Hinge& hinge : weak.hinges) least = std::min(least, margin(hinge.name));
      CAPTURE(weakest);
      CHECK(margin("*") == least);
      CHECK(margin(weak.hinges[weakest].name) == least);
    }
}
