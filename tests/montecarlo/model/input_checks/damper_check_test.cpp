#include "montecarlo/model/input_checks/check_input.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "tests/support/source_folder.hpp"

#include <catch2/catch.hpp>

#include <initializer_list>
#include <string>

using namespace wingspread;

namespace {

/// The warnings of the flight scene with these hinges damped, one line each.
std::string warnings_of(std::initializer_list<int> damped, double t_end) {
  const std::filesystem::path folder = std::filesystem::path(source_folder) / "studies/scenes";
  Scene scene = read_scene_file(folder / "three_panel_flight.json");
  Damper damper;
  damper.coefficient = 120;
  for (const int hinge : damped) scene.hinges[hinge].damper = damper;
  Integration integration;
  integration.t_end = t_end;
  std::string text;
  for (const InputWarning& warning : check_input(scene, integration, ""))
    if (warning.pointer.ends_with("/damper")) text += warning.found + '\n';
  return text;
}

} // namespace

// The scene latches last at 6.959 s without dampers, and by the damper of mid at 452 s.
TEST_CASE("a slow damper is warned of with the nominal time where that is known",
          "[input_checks]") {
  using Catch::Contains;
  CHECK_THAT(warnings_of({1}, 3000), Contains("a nominal deployment of 452") &&
                                         Contains(", 6.959 s without dampers") &&
                                         !Contains("bound"));
  CHECK_THAT(warnings_of({1}, 60),
             Contains("more than 69.59 s by this damper alone (a lower bound), 6.959 s without"));
  CHECK_THAT(warnings_of({0, 1}, 5000),
             Contains("a nominal deployment of ") &&
                 Contains(", more than 69.59 s by this damper alone (a lower bound)"));
}
