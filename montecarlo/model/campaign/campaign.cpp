#include "montecarlo/model/campaign/campaign.hpp"

#include "core/scene/curve.hpp"
#include "distributions/prepared_distribution.hpp"
#include "distributions/random_stream.hpp"
#include "distributions/step_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>
#include <map>
#include <set>
#include <type_traits>
#include <variant>

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

namespace {

/// A parameter's value after the effect; nothing if it differs from run to run.
/// @param value, effect nothing if they differ from run to run
std::optional<double> after_effect(std::optional<double> value, Apply how,
                                   const std::optional<double>& effect) {
  if (how == Apply::set) return effect;
  if (how == Apply::scale && (value == 0.0 || effect == 0.0)) return 0;
  if (!value || !effect) return std::nullopt;
  apply_to(*value, how, *effect);
  return value;
}

} // namespace

std::vector<double> telling_draws(const Distribution& distribution, const Curve* table,
                                  double tail) {
  const PreparedDistribution law(distribution);
  const double low = law.quantile(tail), high = law.quantile_complement(tail);
  std::vector<double> draws = std::visit(
      [&](const auto& own) {
        if constexpr (Continuous<std::decay_t<decltype(own)>>)
          return table ? table->knots() : std::vector<double>();
        else
          return step_law(own).values;
      },
      distribution.law);
  std::erase_if(draws, [&](double draw) { return draw <= low || draw >= high; });
  draws.insert(draws.begin(), low);
  draws.push_back(high);
  return draws;
}

std::optional<double> one_effect(const Distribution& distribution, const Curve* table) {
  constexpr double tail = 1e-12; // beyond any campaign's number of runs
  const auto effect = [&](double draw) { return table ? table->value_at(draw) : draw; };
  const std::vector<double> draws = telling_draws(distribution, table, tail);
  const double first = effect(draws.front());
  const bool is_one =
      std::ranges::all_of(draws, [&](double draw) { return effect(draw) == first; });
  return is_one ? std::optional(first) : std::nullopt;
}

bool vary(const Campaign& campaign) {
  std::map<SceneParameter, std::optional<double>> values;
  for (const Dispersion& dispersion : campaign.dispersions)
    for_each_effect(dispersion, [&](Apply how, const auto& targets, const Curve* table) {
      const std::optional<double> effect = one_effect(dispersion.distribution, table);
      for (const SceneParameter& target : targets) {
        const auto at = values.try_emplace(target, target.in(campaign.scene)).first;
        at->second = after_effect(at->second, how, effect);
      }
    });
  return std::ranges::any_of(values, [](const auto& value) { return !value.second; });
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
