#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "montecarlo/report/text/outcome_report.hpp"
#include "montecarlo/results/summary/latch_jump.hpp"
#include "montecarlo/results/summary/summary_json.hpp"
#include "montecarlo/results/summary/warnings.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <utility>

using namespace wingspread;

namespace {

/// Both hinges of the small wing latched, mid first, with the peaks of their moments.
struct Latched {
  Scene scene = read_scene(test::small_scene());
  Outcome outcome;

  Latched() {
    scene.hinges[0].latch = Latch{1e4, 100};
    scene.hinges[1].latch = Latch{2e3, 7};
    outcome.status = Status::deployed, outcome.peaks_final = true;
    outcome.latches = {{1, 2.0, {0.25, -3}}, {0, 3.0, {-2, 9}}};
    outcome.peak_moment = {{350, 3.1}, {50, 2.5}};
    outcome.final.angles = outcome.final.rates = {0, 0};
  }
};

} // namespace

TEST_CASE("a latch whose damping times its own rate exceeds half the peak is warned of") {
  Latched wing;
  const std::vector<LatchJump> found = latch_jumps(wing.scene, wing.outcome); // mid: 21 of 50
  REQUIRE(found.size() == 1);
  CHECK((found[0].hinge == "root" && found[0].moment == 200 && found[0].peak == 350));
  const std::string text =
      "latch damping makes most of the peak moment of root (57 %): as a latch "
      "engages, its moment jumps to damping times rate; with \"dissipation\" in "
      "place of \"damping\" in the scene it does not";
  CHECK(warning(found) == text);
  CHECK(outcome_warnings(wing.scene, wing.outcome) == std::vector{text});
  CHECK(outcome_json(wing.scene, wing.outcome)["warnings"] == Json::array({text}));
  CHECK_THAT(outcome_text(wing.scene, wing.outcome),
             Catch::Contains("\nWARNING\n  " + wrapped(text, 2) + '\n'));
  Summary summary;
  summary.latch_jumps = found;
  CHECK(warnings(summary) == std::vector{"in the nominal run: " + text});
  wing.outcome.peak_moment[0].value = 400; // half of it, not more
  CHECK(latch_jumps(wing.scene, wing.outcome).empty());
  wing.outcome.peak_moment[1].value = 41;
  CHECK(latch_jumps(wing.scene, wing.outcome).at(0).hinge == "mid");
  wing.outcome.peak_moment[0].value = 210;
  CHECK_THAT(warning(latch_jumps(wing.scene, wing.outcome)),
             Catch::Contains(" of root (95 %), mid (51 %): ")); // one line for both
  wing.outcome.peak_moment[0].value = 199; // the jump, less the spring's moment
  CHECK_THAT(warning(latch_jumps(wing.scene, wing.outcome)), Catch::Contains(" root (100 %), "));
}

TEST_CASE("a latch that engages again is named once, by its largest jump") {
  Latched wing;
  const auto found = [&] { return latch_jumps(wing.scene, wing.outcome); };
  wing.outcome.latches = {{0, 3.0, {-2, 9}}, {0, 4.0, {2.5, 9}}, {0, 5.0, {-1.9, 9}}};
  REQUIRE(found().size() == 1);
  CHECK((found()[0].hinge == "root" && found()[0].moment == 250 && found()[0].peak == 350));
  std::ranges::reverse(wing.outcome.latches);
  REQUIRE(found().size() == 1);
  CHECK(found()[0].moment == 250);
  wing.outcome.latches = {{0, 3.0, {-1, 9}}, {0, 4.0, {-1, 9}}}; // two small jumps are no large one
  CHECK(found().empty());
}

TEST_CASE("the mirrored wing has the same latch jumps") {
  Latched wing;
  const std::vector<LatchJump> before = latch_jumps(wing.scene, wing.outcome);
  for (LatchEvent& latch : wing.outcome.latches)
    for (double& rate : latch.rates) rate = -rate;
  const std::vector<LatchJump> after = latch_jumps(wing.scene, wing.outcome);
  REQUIRE((before.size() == 1 && after.size() == 1));
  CHECK(after[0].moment == before[0].moment);
}

TEST_CASE("a force at the instant of a latch's jump on a flexible body is warned of") {
  Latched wing;
  const auto forces = [&] { return forces_of_jumps(wing.scene, wing.outcome); };
  wing.outcome.peak_force = {{397, 3.0}, {40, 2.0}}; // each when its own latch engages
  CHECK(forces().empty());                           // rigid bodies: the force is theirs
  wing.scene.bodies[wing.scene.hinges[1].child].flexible = Flexible{4, 200.0};
  CHECK(forces() == std::vector<std::string>{"mid"});
  std::swap(wing.scene.bodies[wing.scene.hinges[1].child].flexible,
            wing.scene.bodies[wing.scene.hinges[1].parent].flexible); // it bends on the other side
  CHECK(std::ranges::count(forces(), "mid") == 1);
  std::swap(wing.scene.bodies[wing.scene.hinges[1].child].flexible,
            wing.scene.bodies[wing.scene.hinges[1].parent].flexible);
  wing.outcome.peak_force[0].time = 2.0; // the root's, as mid engages
  CHECK(forces() == std::vector<std::string>{"root", "mid"});
  const std::string text =
      "root.peak_force, mid.peak_force: in proportion to the number of \"joints\", without a "
      "limit: "
      "as a latch engages, its damping times rate acts at once on the end segment of a flexible "
      "body, which is lighter the more joints there are; with \"dissipation\" in place of "
      "\"damping\" in the scene the force converges";
  CHECK(warning_of_forces(forces()) == text);
  const auto lines = outcome_warnings(wing.scene, wing.outcome);
  CHECK(std::ranges::find(lines, text) != lines.end());
  Summary summary;
  summary.jump_forces = forces();
  CHECK(warnings(summary) == std::vector{"in the nominal run: " + text});
  wing.outcome.peak_force[0].time = wing.outcome.peak_force[1].time = 2.5; // later: not the jump's
  CHECK(forces().empty());
  wing.outcome.peak_force[1].time = 2.0;
  wing.scene.hinges[1].latch = Latch{2e3, 0, 0, 0.5};
  CHECK(forces().empty());
}

TEST_CASE("no latch is warned of without a jump, or without known peaks") {
  Latched wing;
  Outcome other = wing.outcome;
  other.peak_moment.clear();
  CHECK(latch_jumps(wing.scene, other).empty());
  other = wing.outcome, other.status = Status::failed;
  CHECK(latch_jumps(wing.scene, other).empty());
  other = wing.outcome, other.latches.pop_back();
  CHECK(latch_jumps(wing.scene, other).empty());
  wing.scene.hinges[0].latch = Latch{1e4, 0, 0, 0.5};
  CHECK(latch_jumps(wing.scene, wing.outcome).empty());
}
