#include "montecarlo/report/trajectory.hpp"

#include "montecarlo/formats/csv.hpp"

#include <utility>

namespace wingspread {
namespace {

constexpr std::size_t trajectory_block = 1 << 16; // bytes

} // namespace

TrajectoryWriter::TrajectoryWriter(std::filesystem::path path, const Scene& scene)
    : out_(std::move(path)), base_(scene.base.motion), block_("t") {
  for (const Hinge& hinge : scene.hinges)
    for (const char* quantity : {".angle", ".rate", ".moment"})
      append_csv_cells(block_, hinge.name + quantity);
  block_ += ",kinetic,potential,total";
  if (base_ != BaseMotion::fixed) block_ += ",base.angle,base.rate";
  if (base_ == BaseMotion::free) block_ += ",base.position.0,base.position.1";
  block_ += '\n';
}

Observer TrajectoryWriter::observer() {
  return [this](const Sample& sample) { write(sample); };
}

void TrajectoryWriter::write(const Sample& sample) {
  append_csv_cell(block_, sample.t);
  for (std::size_t i = 0; i < sample.angles.size(); ++i)
    append_csv_cells(block_, sample.angles[i], sample.rates[i], sample.moments[i]);
  append_csv_cells(block_, sample.kinetic, sample.potential, sample.kinetic + sample.potential);
  if (base_ != BaseMotion::fixed) append_csv_cells(block_, sample.base_angle, sample.base_rate);
  if (base_ == BaseMotion::free)
    append_csv_cells(block_, sample.base_position[0], sample.base_position[1]);
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
