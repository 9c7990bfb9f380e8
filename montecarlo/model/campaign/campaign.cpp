#include "montecarlo/model/campaign/campaign.hpp"

#include "core/scene/curve.hpp"
#include "distributions/prepared_distribution.hpp"
#include "distributions/random_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <set>

namespace wingspread {
InterimAnalyses interim_analyses(const Campaign& campaign) {
  const auto& before = campaign.sampling.extended_from;
  return {count_interim_analyses(campaign.until, campaign.sampling.runs),
          {before.begin(), before.end()}};
}

std::string campaign_hash(const Json& resolved) {
  Json hashed = resolved;
  hashed.erase(stamp_key);
  return fmt::format("{:016x}", stream_name(hashed.dump()).hash); // FNV-1a
}

std::size_t entry_of(const Campaign& campaign, const Dispersion& dispersion) {
  const Json& list = campaign.resolved.at("dispersions");
  const std::string& own = dispersion.rows.empty() ? dispersion.name : dispersion.rows;
  std::size_t found = list.size(), length = 0; // of the longest name of an `each` that begins it
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string name = list[i].at("name").get<std::string>();
    if (name == own) return i;
    if (list[i].contains("each") && own.starts_with(name + ".") && name.size() >= length)
      found = i, length = name.size();
  }
  assert(found < list.size());
  return found;
}

bool is_drawn_by(const Campaign& campaign, const std::string& entry, const Dispersion& dispersion) {
  const Json& list = campaign.resolved.at("dispersions");
  return list[entry_of(campaign, dispersion)].at("name") == entry;
}

std::vector<SceneParameter> dispersed_parameters(std::span<const Dispersion> dispersions) {
  std::vector<SceneParameter> parameters;
  std::set<SceneParameter> known;
  for (const Dispersion& dispersion : dispersions)
    for_each_effect(dispersion, [&](Apply, const auto& targets, const Curve*) {
      for (const SceneParameter& target : targets)
        if (known.insert(target).second) parameters.push_back(target);
    });
  return parameters;
}

void apply(const Campaign& campaign, std::span<const double> draws, const Scene& nominal,
           Scene& run_scene) {
  assert(draws.size() == campaign.dispersions.size());
  for (const Dispersion& dispersion : campaign.dispersions)
    for_each_effect(dispersion, [&](Apply, const auto& targets, const Curve*) {
      for (const SceneParameter& target : targets) target.in(run_scene) = target.in(nominal);
    });
  for (std::size_t i = 0; i < draws.size(); ++i)
    for_each_effect(campaign.dispersions[i],
                    [&](Apply how, const auto& targets, const Curve* table) {
                      const double effect = table ? table->value_at(draws[i]) : draws[i];
                      for (const SceneParameter& target : targets)
                        apply_to(target.in(run_scene), how, effect);
                    });
}

Scene nominal_scene(const Campaign& campaign) {
  std::vector<double> medians;
  for (const Dispersion& dispersion : campaign.dispersions)
    medians.push_back(PreparedDistribution(dispersion.distribution).quantile(0.5));
  return scene_with(campaign, medians);
}

Scene scene_with(const Campaign& campaign, std::span<const double> draws) {
  Scene scene = campaign.scene;
  apply(campaign, draws, campaign.scene, scene);
  return scene;
}

} // namespace wingspread
