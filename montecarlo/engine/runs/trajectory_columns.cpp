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

std::string_view unit_of_column(const std::string& name) {
  const std::string last = name.substr(name.find_last_of('.') + 1);
  if (last == "angle") return "rad";
  if (last == "rate") return "rad/s";
  if (last == "moment") return "N·m";
  if (name.starts_with("base.position")) return "m";
  return "J";
}

} // namespace wingspread
