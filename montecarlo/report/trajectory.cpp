#include "montecarlo/report/trajectory.hpp"

#include "montecarlo/formats/csv.hpp"
#include "montecarlo/formats/files.hpp"

#include <utility>

namespace wingspread {

TrajectoryWriter::TrajectoryWriter(std::filesystem::path path, const Scene& scene)
    : path_(std::move(path)), out_(path_, std::ios::binary | std::ios::trunc) {
  std::string header = "t";
  for (const Hinge& hinge : scene.hinges)
    for (const char* quantity : {".angle", ".rate", ".moment"})
      append_csv_cells(header, hinge.name + quantity);
  out_ << header << ",kinetic,potential,total\n";
  if (!out_) throw unwritable(path_);
}

Observer TrajectoryWriter::observer() {
  return [this](const Sample& sample) { write(sample); };
}

void TrajectoryWriter::write(const Sample& sample) {
  std::string line;
  append_csv_cell(line, sample.t);
  for (std::size_t i = 0; i < sample.angles.size(); ++i)
    append_csv_cells(line, sample.angles[i], sample.rates[i], sample.moments[i]);
  append_csv_cells(line, sample.kinetic, sample.potential, sample.kinetic + sample.potential);
  out_ << line << '\n';
}

void TrajectoryWriter::finish() {
  if (!out_.flush()) throw unwritable(path_);
}

} // namespace wingspread
