#include "montecarlo/campaign/campaign.hpp"

#include "distributions/random_stream.hpp"

#include <fmt/format.h>

#include <cassert>
#include <iterator>

namespace wingspread {
namespace {

void apply_draw(Apply how, double draw, double& target) {
  switch (how) {
  case Apply::set:
    target = draw;
    break;
  case Apply::scale:
    target *= draw;
    break;
  case Apply::add:
    target += draw;
    break;
  }
}

} // namespace

long count_looks(const Campaign& campaign) {
  if (campaign.until.empty()) return 1 + std::ssize(campaign.sampling.extended_from);
  return count_looks(campaign.until, campaign.sampling.runs);
}

std::string campaign_hash(const Json& resolved) {
  Json hashed = resolved;
  hashed.erase(stamp_key);
  return fmt::format("{:016x}", stream_name(hashed.dump()).hash); // FNV-1a
}

void apply(const Campaign& campaign, std::span<const double> draws, const Scene& nominal,
           Scene& run_scene) {
  assert(draws.size() == campaign.dispersions.size());
  for (const Dispersion& dispersion : campaign.dispersions)
    for (const SceneParameter& target : dispersion.targets)
      target.in(run_scene) = target.in(nominal);
  for (std::size_t i = 0; i < draws.size(); ++i) {
    const Dispersion& dispersion = campaign.dispersions[i];
    for (const SceneParameter& target : dispersion.targets)
      apply_draw(dispersion.apply, draws[i], target.in(run_scene));
  }
}

} // namespace wingspread
