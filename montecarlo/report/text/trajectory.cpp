#include "montecarlo/report/text/trajectory.hpp"

#include "montecarlo/foundation/formats/csv.hpp"

#include <utility>

namespace wingspread {
namespace {

constexpr std::size_t trajectory_block = 1 << 16; // bytes

} // namespace

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
