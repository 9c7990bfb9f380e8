#include "montecarlo/report/text/trajectory.hpp"

#include "montecarlo/foundation/formats/csv.hpp"

#include <utility>

namespace wingspread {
namespace {

constexpr std::size_t trajectory_block = 1 << 16; // bytes

} // namespace

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

TrajectoryWriter::TrajectoryWriter(std::filesystem::path path, const Scene& scene)
    : out_(std::move(path)), base_(scene.base.motion) {
  for (const std::string& column : trajectory_columns(scene)) {
    if (!block_.empty()) block_ += ',';
    append_csv_cell(block_, column);
  }
  block_ += '\n';
}

Observer TrajectoryWriter::observer() {
  return [this](const Sample& sample) { write(sample); };
}

void TrajectoryWriter::write(const Sample& sample) {
  const std::size_t before = block_.size();
  take_sample(sample, base_, [&](double value) {
    if (block_.size() > before) block_ += ',';
    append_csv_cell(block_, value);
  });
  block_ += '\n';
  if (block_.size() < trajectory_block) return;
  out_.write(block_);
  block_.clear();
}

void TrajectoryWriter::finish() {
  out_.write(block_);
  out_.finish();
}

} // namespace wingspread
