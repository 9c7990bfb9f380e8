// The places that warnings of a wing's shape name.
#include "montecarlo/model/input_checks/shape_checks.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

using namespace wingspread;

namespace {

/// A chain of panels, each 1 m long and 0.2 mm thick, of which one is folded back onto the panel before it.
/// @param backwards the hinges in the file begin at the tip
Scene chain(int panels, int folded, bool backwards) {
  Scene scene;
  for (int k = 0; k < panels; ++k) {
    scene.bodies.push_back({"panel_" + std::to_string(k), 1, 1});
    Hinge hinge;
    hinge.name = "hinge_" + std::to_string(k);
    hinge.parent = k == 0 ? base_index : k - 1, hinge.child = k;
    hinge.child_point = {-0.5, 1e-4};
    if (k > 0) hinge.parent_point = {0.5, 1e-4};
    hinge.stowed = k == folded ? std::numbers::pi : 0.4;
    scene.hinges.push_back(hinge);
  }
  if (backwards) std::ranges::reverse(scene.hinges);
  return scene;
}

std::vector<InputWarning> stowed_warnings(const Scene& scene) {
  InputWarnings warnings({"wing.json", ""});
  check_shape(scene, warnings);
  std::vector<InputWarning> stowed;
  for (const InputWarning& each : warnings.list())
    if (each.found.ends_with(" when stowed")) stowed.push_back(each);
  return stowed;
}

} // namespace

// The angle of the inner body's hinge moves both bodies: no value of it parts them.
TEST_CASE("another angle at the hinge that a warning names parts bodies in one place",
          "[warnings]") {
  for (const bool backwards : {false, true})
    for (int panels = 2; panels < 6; ++panels)
      for (int folded = 1; folded < panels; ++folded) {
        CAPTURE(backwards, panels, folded);
        Scene scene = chain(panels, folded, backwards);
        const std::vector<InputWarning> found = stowed_warnings(scene);
        REQUIRE(found.size() == 1);
        const std::string inner = "panel_" + std::to_string(folded - 1),
                          outer = "panel_" + std::to_string(folded);
        CHECK(found[0].found.starts_with(inner + " and " + outer));
        std::size_t named = scene.hinges.size();
        for (std::size_t h = 0; h < scene.hinges.size(); ++h)
          if (found[0].pointer == "/hinges/" + std::to_string(h) + "/angle/stowed") named = h;
        REQUIRE(named < scene.hinges.size());
        scene.hinges[named].stowed = 0.4;
        CHECK(stowed_warnings(scene).empty());
      }
}
