#include "montecarlo/report/data/page_detail.hpp"

#include <algorithm>
#include <cmath>

namespace wingspread {
namespace {

// Largest count of numbers per part of a page: 425,000 in all, some 3.4 MB at 8 to 9 bytes a number. The split between
// the parts is heuristic. Larger values break the limit of 3.5 MB for the page's data (page/DATA.md).
constexpr double most_output_numbers = 140'000, most_motion_numbers = 130'000,
                 most_envelope_numbers = 60'000, most_scatter_numbers = 45'000,
                 most_effect_numbers = 20'000, most_correlations = 30'000;
constexpr std::size_t most_parameters = 4500;

/// The share of the wanted numbers for which there is room: at most 1.
double share_of(double room, double wanted) { return std::min(1.0, room / wanted); }

std::size_t scaled(std::size_t full, double share, std::size_t least) {
  return std::max(least, static_cast<std::size_t>(std::floor(static_cast<double>(full) * share)));
}

/// Numbers of one output: histogram by latch order (6 orders, others, none, and the total), curve, convergence.
double output_numbers(const PageDetail& detail) {
  constexpr double groups = 9;
  return groups * static_cast<double>(detail.bins) + 4 * static_cast<double>(detail.knots) +
         7 * static_cast<double>(detail.convergence_points);
}

/// @param outputs of all sets together
void share_outputs(double outputs, double sets, PageDetail& detail) {
  const double share = share_of(most_output_numbers, outputs * output_numbers(detail));
  detail.bins = scaled(detail.bins, share, 10);
  detail.knots = scaled(detail.knots, share, 17);
  detail.convergence_points = scaled(detail.convergence_points, share, 6);
  const double room = most_output_numbers / sets / output_numbers(detail);
  detail.outputs = std::min(detail.outputs, static_cast<std::size_t>(room));
}

/// @param hinges of all sets together
void share_motions(double hinges, PageDetail& detail) {
  const auto numbers = [&] {
    return 3 * hinges * static_cast<double>(detail.motions * detail.motion_samples);
  };
  detail.motion_samples =
      scaled(detail.motion_samples, share_of(most_motion_numbers, numbers()), 60);
  detail.motions = scaled(detail.motions, share_of(most_motion_numbers, numbers()), 2);
}

/// @param hinges of all sets together
void share_envelopes(double hinges, PageDetail& detail) {
  constexpr double quantiles = 7;
  const double numbers = hinges * (2 * quantiles * static_cast<double>(detail.envelope_times) +
                                   static_cast<double>(detail.latch_times));
  const double share = share_of(most_envelope_numbers, numbers);
  detail.envelope_times = scaled(detail.envelope_times, share, 12);
  detail.latch_times = scaled(detail.latch_times, share, 20);
}

/// Sets the number of runs replayed for the envelopes. The cost of a run grows with the square of its number of hinges.
/// Heuristic: 8000 keeps the replay within seconds; a larger value makes the report slower than the campaign.
void share_envelope_runs(const PageExtent& extent, PageDetail& detail) {
  constexpr std::size_t hinges_squared = 8000, fewest = 24;
  const std::size_t each = extent.sets * std::max<std::size_t>(extent.hinges * extent.hinges, 1);
  detail.envelope_runs = std::clamp(hinges_squared / each, fewest, detail.envelope_runs);
}

} // namespace

PageDetail page_detail(const PageExtent& extent) {
  const double sets = static_cast<double>(extent.sets);
  const double hinges = sets * static_cast<double>(std::max<std::size_t>(extent.hinges, 1));
  const double outputs = sets * static_cast<double>(std::max<std::size_t>(extent.outputs, 1));
  constexpr double of_scatter = 1024 + 66 + 4 * 400, of_effect = 8;
  PageDetail detail;
  share_outputs(outputs, sets, detail);
  share_motions(hinges, detail);
  share_envelopes(hinges, detail);
  share_envelope_runs(extent, detail);
  const double scatters = sets * of_scatter * static_cast<double>(detail.scatters);
  detail.scatters = scaled(detail.scatters, share_of(most_scatter_numbers, scatters), 1);
  const double effects = std::min(outputs, sets * static_cast<double>(detail.outputs)) * of_effect *
                         static_cast<double>(detail.effects);
  detail.effects = scaled(detail.effects, share_of(most_effect_numbers, effects), 2);
  const double shown = sets * static_cast<double>(std::min(extent.outputs, detail.outputs));
  detail.correlated_draws =
      std::clamp<std::size_t>(static_cast<std::size_t>(most_correlations / std::max(shown, 1.0)), 1,
                              detail.correlated_draws);
  detail.parameters =
      std::clamp<std::size_t>(most_parameters / extent.sets, 200, detail.parameters);
  return detail;
}

} // namespace wingspread
