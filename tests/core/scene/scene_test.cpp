#include "core/scene/scene.hpp"
#include "tests/support/closed_forms.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE("hinges have an order outwards where every body hangs on the base by one way") {
  Scene scene = oracle::coaxial_discs(3, 2);
  CHECK(outward_order(scene) == std::vector{0, 1});
  CHECK(outward_order(oracle::reversed(scene)) == std::vector{1, 0});
  Hinge& second = scene.hinges[1];
  second.parent = base_index, second.child = 0; // the first disc by two hinges, the other by none
  CHECK(outward_order(scene).empty());
  second.parent = 1, second.child = 1; // on itself
  CHECK(outward_order(scene).empty());
  second.parent = 0, second.child = 2; // on nothing
  CHECK(outward_order(scene).empty());
  second.child = 1;
  scene.hinges.pop_back();
  CHECK(outward_order(scene).empty());
}
