#include "montecarlo/results/summary/overtravel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace wingspread {
namespace {

void take(Overtravel& so_far, double value) {
  if (!(value > most_overtravel)) return; // also if the value is NaN (unknown)
  ++so_far.runs;
  so_far.largest = std::max(so_far.largest, value);
}

} // namespace

std::vector<Overtravel> overtravels(const Scene& scene, const Results& results) {
  std::vector<Overtravel> found;
  for (const Hinge& hinge : scene.hinges) {
    const auto column =
        std::ranges::find(results.outputs, hinge.name + ".overtravel", &Column::name);
    if (hinge.stop || column == results.outputs.end()) continue;
    Overtravel overtravel{hinge.name};
    for (const double value : column->values) take(overtravel, value);
    column->values.release();
    if (overtravel.runs > 0) found.push_back(std::move(overtravel));
  }
  return found;
}

std::vector<Overtravel> overtravels(const Scene& scene, const Outcome& outcome) {
  std::vector<Overtravel> found;
  for (std::size_t i = 0; i < outcome.overtravel.size(); ++i) {
    Overtravel overtravel{scene.hinges[i].name};
    if (!scene.hinges[i].stop) take(overtravel, outcome.overtravel[i]);
    if (overtravel.runs > 0) found.push_back(std::move(overtravel));
  }
  return found;
}

std::string warning(const Overtravel& overtravel) {
  return fmt::format(
      "{} turns up to {:.3g} deg backwards, beyond its stowed angle (overtravel); it has no stop",
      overtravel.hinge, overtravel.largest * 180 / std::numbers::pi);
}

std::string warning(const Overtravel& overtravel, long of_runs) {
  return fmt::format("in {} of {} runs {}", overtravel.runs, of_runs, warning(overtravel));
}

} // namespace wingspread
