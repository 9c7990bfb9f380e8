#include "montecarlo/page_data/page_detail.hpp"

#include <algorithm>
#include <cmath>

namespace wingspread {
namespace {

// Numbers of each part on one page, at some 9 bytes a number: 3.4 MB together.
constexpr double most_output_numbers = 140'000, most_motion_numbers = 130'000,
                 most_envelope_numbers = 60'000, most_scatter_numbers = 45'000,
                 most_effect_numbers = 20'000;

/// A part's share of what it would take in full: 1 where there is room for all of it.
double share_of(double room, double wanted) { return std::min(1.0, room / wanted); }

std::size_t scaled(std::size_t full, double share, std::size_t least) {
  return std::max(least, static_cast<std::size_t>(std::floor(static_cast<double>(full) * share)));
}

} // namespace

PageDetail page_detail(const PageExtent& extent) {
  constexpr double most_motions = 12, groups = 9, levels = 7;
  const double sets = static_cast<double>(extent.sets);
  const double hinges = static_cast<double>(extent.hinges);
  const double outputs = static_cast<double>(extent.outputs);
  PageDetail detail;
  const double of_output = groups * static_cast<double>(detail.bins) +
                           4 * static_cast<double>(detail.knots) +
                           7 * static_cast<double>(detail.checkpoints);
  const double output = share_of(most_output_numbers, sets * outputs * of_output);
  detail.bins = scaled(detail.bins, output, 10);
  detail.knots = scaled(detail.knots, output, 17);
  detail.checkpoints = scaled(detail.checkpoints, output, 6);
  const double motion =
      share_of(most_motion_numbers,
               sets * most_motions * 3 * hinges * static_cast<double>(detail.motion_samples));
  detail.motion_samples = scaled(detail.motion_samples, motion, 40);
  const double envelope =
      share_of(most_envelope_numbers, sets * hinges *
                                          (2 * levels * static_cast<double>(detail.envelope_times) +
                                           static_cast<double>(detail.latch_times)));
  detail.envelope_times = scaled(detail.envelope_times, envelope, 20);
  detail.latch_times = scaled(detail.latch_times, envelope, 20);
  detail.envelope_runs = std::clamp<std::size_t>(
      2000 / std::max<std::size_t>(extent.hinges * extent.sets, 1), 40, detail.envelope_runs);
  constexpr double of_scatter = 1024 + 66 + 4 * 400;
  const double scatter =
      share_of(most_scatter_numbers, sets * static_cast<double>(detail.scatters) * of_scatter);
  detail.scatters = scaled(detail.scatters, scatter, 1);
  constexpr double of_effect = 8;
  const double effect = share_of(most_effect_numbers,
                                 sets * outputs * of_effect * static_cast<double>(detail.effects));
  detail.effects = scaled(detail.effects, effect, 2);
  return detail;
}

} // namespace wingspread
