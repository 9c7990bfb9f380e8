#include "montecarlo/model/input_checks/size_checks.hpp"

#include <catch2/catch.hpp>

#include <random>
#include <string>
#include <vector>

using namespace wingspread;

namespace {

/// Where the sizes of two panels are warned of, after a change.
template <class Change> std::vector<std::string> oversized(const Change& change) {
  Scene scene;
  for (int k = 0; k < 2; ++k) {
    scene.bodies.push_back({"panel", 10, 0.85});
    Hinge hinge;
    hinge.parent = k - 1, hinge.child = k;
    hinge.parent_point = {k == 0 ? 0.0 : 0.505, 0.02};
    hinge.child_point = {-0.505, 0.02};
    hinge.stowed = 1.5;
    hinge.name = "hinge " + std::to_string(k);
    scene.hinges.push_back(hinge);
  }
  change(scene);
  InputWarnings warnings({"wing.json", ""});
  check_sizes(scene, warnings);
  std::vector<std::string> found;
  for (const InputWarning& warning : warnings.list()) found.push_back(warning.pointer);
  return found;
}

} // namespace

TEST_CASE("one wrong unit of length is one warning, at that length", "[warnings]") {
  CHECK(oversized([](Scene&) {}).empty());
  CHECK(oversized([](Scene& scene) { scene.hinges[0].child_point *= 1000; }) ==
        std::vector<std::string>{"/hinges/0/child_point"});
  CHECK(oversized([](Scene& scene) { scene.hinges[1].child_point *= 1000; }) ==
        std::vector<std::string>{"/hinges/1/child_point"});
  CHECK(oversized([](Scene& scene) { scene.hinges[1].parent_point *= 1000; }) ==
        std::vector<std::string>{"/hinges/1/parent_point"});
}

// Edges are allowed up to 20 radii of gyration, 5.8 m, from the centre of mass.
TEST_CASE("a plate's edge is too far out whichever end it is given as", "[warnings]") {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> place(-7, 7);
  int warned = 0;
  for (int k = 0; k < 200; ++k) {
    Plate plate;
    plate.from = {place(random), place(random)}, plate.to = {place(random), place(random)};
    const auto told = [&] {
      auto list = oversized([&](Scene& scene) { scene.bodies[1].plate = plate; });
      std::erase_if(list, [](const std::string& each) { return each != "/bodies/1/plate"; });
      return list.size();
    };
    const double radius = std::sqrt(0.85 / 10);
    const std::size_t far = std::max(plate.from.norm(), plate.to.norm()) > 20 * radius ? 1 : 0;
    CAPTURE(plate.from.transpose(), plate.to.transpose());
    CHECK(told() == far);
    std::swap(plate.from, plate.to);
    CHECK(told() == far);
    warned += static_cast<int>(far);
  }
  CHECK((warned > 50 && warned < 150));
}
