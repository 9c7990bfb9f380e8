#include "montecarlo/engine/runs/trajectory_columns.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE("a trajectory has a column for each freedom, moment and energy, with its unit") {
  Scene scene;
  scene.bodies = {{"panel", 10, 0.5}};
  scene.hinges.resize(1);
  scene.hinges[0].name = "base.position"; // as a base's columns begin
  scene.base.motion = BaseMotion::free;
  using Columns = std::vector<std::pair<std::string, std::string_view>>;
  Columns found;
  const std::vector<std::string> columns = trajectory_columns(scene);
  CHECK(columns.front() == "t");
  for (std::size_t k = 1; k < columns.size(); ++k)
    found.emplace_back(columns[k], unit_of_column(columns[k]));
  CHECK(found == Columns{{"base.position.angle", "rad"},
                         {"base.position.rate", "rad/s"},
                         {"base.position.moment", "N·m"},
                         {"kinetic", "J"},
                         {"potential", "J"},
                         {"total", "J"},
                         {"base.angle", "rad"},
                         {"base.rate", "rad/s"},
                         {"base.position.0", "m"},
                         {"base.position.1", "m"}});
  scene.base.motion = BaseMotion::prescribed;
  CHECK(trajectory_columns(scene).back() == "base.rate");
  scene.base.motion = BaseMotion::fixed;
  CHECK(trajectory_columns(scene).back() == "total");
}
