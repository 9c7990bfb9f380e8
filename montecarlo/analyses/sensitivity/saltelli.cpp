#include "montecarlo/analyses/sensitivity/saltelli.hpp"

#include "montecarlo/analyses/sensitivity/sobol_indices.hpp"
#include "montecarlo/foundation/formats/spec_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>

namespace wingspread {
namespace {

/// Names of the coordinates of A, then of B. B's have a control character, which no dispersion's name may contain, so
/// that they differ from A's and sort behind them.
std::vector<std::string> coordinates(const Campaign& campaign) {
  const Coordinates one = coordinates_of(campaign.dispersions);
  std::vector<std::string> names;
  for (const char* prefix : {"", "\x7F"})
    for (const std::string& name : one.names) names.push_back(prefix + name);
  return names;
}

PreparedDesign design(const Campaign& campaign, long rows) {
  const Sampling& sampling = campaign.sampling;
  return {{sampling.design, sampling.seed, static_cast<std::uint64_t>(rows),
           static_cast<std::uint64_t>(saltelli_replicates(sampling, rows))},
          coordinates(campaign)};
}

void refuse_unsuitable(const Campaign& campaign) {
  if (!vary(campaign.dispersions))
    throw SpecError({{"", "/dispersions",
                      campaign.dispersions.empty() ? "none" : "laws with a single value only",
                      "at least one that varies"}});
  const std::size_t d = coordinates_of(campaign.dispersions).names.size(); // one for a `rows`
  if (campaign.sampling.design == DesignKind::sobol && 2 * d > most_sobol_dimensions)
    throw SpecError({{"", "/dispersions", fmt::format("{}", d),
                      fmt::format("at most {} for Sobol' points: the design takes two coordinates "
                                  "for each",
                                  most_sobol_dimensions / 2)}});
  if (!campaign.wanted_correlations.empty())
    throw SpecError(
        {{"", "/correlations", fmt::format("{} of them", campaign.wanted_correlations.size()),
          "independent dispersions: a correlated one has no share of the variance of its own (run "
          "the campaign, and take its results folder for rank correlations)"}});
}

} // namespace

long saltelli_replicates(const Sampling& sampling, long rows) {
  return std::clamp<long>(sampling.replicates, 1, rows);
}

long saltelli_runs(long rows, std::size_t dispersions) {
  const long points = static_cast<long>(dispersions) + 2;
  if (rows > std::numeric_limits<long>::max() / points)
    throw SpecError({{"", "--samples", fmt::format("{}", rows),
                      fmt::format("fewer: each takes {} runs", points)}});
  return rows * points;
}

RunPlan saltelli_plan(const Campaign& campaign, long rows) {
  refuse_unsuitable(campaign);
  const auto shared = std::make_shared<const PreparedDesign>(design(campaign, rows));
  const std::size_t d = coordinates_of(campaign.dispersions).names.size();
  return {campaign, [shared, d](long run, std::span<Tails> u) {
            const SaltelliPoint point = saltelli_point(run, d);
            for (std::size_t i = 0; i < d; ++i) {
              const bool from_b = point.place == 1 || point.place == static_cast<long>(i) + 2;
              u[i] = tails_of_uniform(
                  shared->uniform(static_cast<std::uint64_t>(point.row), from_b ? d + i : i));
            }
          }};
}

} // namespace wingspread
