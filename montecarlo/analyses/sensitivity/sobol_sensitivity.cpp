#include "montecarlo/analyses/sensitivity/sobol_sensitivity.hpp"

#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/results/summary/summary.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace wingspread {

std::vector<std::string> SobolSensitivity::idle() const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < dispersions.size(); ++i) {
    const auto inert = [i](const Output& output) { return output.indices.effects[i].inert; };
    const auto known = [](const Output& output) {
      return output.indices.rows > output.indices.incomplete;
    };
    if (std::ranges::find(unvaried, dispersions[i]) != unvaried.end()) continue;
    if (std::ranges::all_of(outputs, inert) && std::ranges::any_of(outputs, known))
      names.push_back(dispersions[i]);
  }
  return names;
}

SobolSensitivity sobol_sensitivity(const Results& results, std::vector<std::string> coordinates,
                                   long rows, std::string design, const SobolBounds& bounds) {
  const std::size_t d = coordinates.size();
  SobolSensitivity all{rows,
                       static_cast<long>(results.size()),
                       rows * static_cast<long>(d + 2),
                       std::move(design),
                       bounds,
                       std::move(coordinates),
                       {}};
  for (const Column& draw : results.draws)
    if (results.size() > 0 &&
        std::ranges::find(all.dispersions, draw.name) != all.dispersions.end() &&
        std::ranges::all_of(draw.values, [&](double x) { return x == draw.values[0]; }))
      all.unvaried.push_back(draw.name);
  for (const Column& output : results.outputs)
    all.outputs.push_back(
        {output.name, sobol_indices(output.values, d, bounds), count_cut(results, output.name)});
  all.open_latches = count_open_latches(results);
  const Column deployed = deployed_column(results);
  if (moments(sorted_present(deployed.values)).std > 0)
    all.outputs.push_back({deployed.name, sobol_indices(deployed.values, d, bounds)});
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < d; ++i)
    if (std::ranges::find(all.unvaried, all.dispersions[i]) != all.unvaried.end())
      for (auto& output : all.outputs)
        output.indices.effects[i] = {{unknown, {}}, {unknown, {}}, false};
  return all;
}

} // namespace wingspread
