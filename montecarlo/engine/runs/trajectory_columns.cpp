#include "montecarlo/engine/runs/trajectory_columns.hpp"

namespace wingspread {

std::vector<std::string> trajectory_columns(const Scene& scene) {
  std::vector<std::string> columns{"t"};
  for (const Hinge& hinge : scene.hinges)
    for (const char* quantity : {".angle", ".rate", ".moment"})
      columns.push_back(hinge.name + quantity);
  columns.insert(columns.end(), {"kinetic", "potential", "total"});
  if (scene.base.motion != BaseMotion::fixed)
    columns.insert(columns.end(), {"base.angle", "base.rate"});
  if (scene.base.motion == BaseMotion::free)
    columns.insert(columns.end(), {"base.position.0", "base.position.1"});
  return columns;
}

} // namespace wingspread
