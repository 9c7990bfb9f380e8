#include "montecarlo/analyses/sensitivity/levers.hpp"

#include "distributions/prepared_distribution.hpp"
#include "montecarlo/model/campaign/plain_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace wingspread {
namespace {

/// Heuristic: a group's best member is named alone if its change is at most this factor larger than the group's. With
/// 1, the report would not say that one member does all the work; with 2, it would name a member although the whole
/// group needs half the change.
constexpr double alone_at_most = 1.25;
/// Heuristic: if a linear fit explains less than this, the runs beyond the limit need not follow its slopes. At 33 %
/// explained a change failed: with a spring × 0.935, 14 of 2,000 new runs broke the limit; 4 were expected, 13 may. At
/// 94 % and more, all of 6 changes passed in all of 12 new campaigns. 0.5 is a guess between: if it is too low, changes
/// fail when run; if it is too high, the report states none.
constexpr double least_explained = 0.5;

/// A draw's lever, and the quantity that it shares with the levers of other bodies or hinges.
struct DrawLever {
  Lever lever;
  std::string quantity;
  std::vector<SceneParameter> targets;
};

/// Whether a change of the draw by a factor means the same as scaling its targets.
bool is_scaled(const Dispersion& dispersion) {
  if (dispersion.targets.empty() || dispersion.apply == Apply::add) return false;
  if (dispersion.apply == Apply::scale) return true;
  const bool angle = std::ranges::any_of(dispersion.targets, [](const SceneParameter& target) {
    return unit_of(target).starts_with("rad");
  });
  return !angle && PreparedDistribution(dispersion.distribution).quantile(0.001) > 0;
}

/// "hinges *.spring.scale by scale": draws with the same text may move together.
std::string quantity_of(const Scene& scene, const Dispersion& dispersion) {
  if (dispersion.targets.empty()) return dispersion.name;
  std::vector<std::string> paths;
  for (const SceneParameter& target : dispersion.targets) {
    std::string path = path_of(scene, target);
    if (target.owner != SceneParameter::Owner::base &&
        target.owner != SceneParameter::Owner::environment)
      path.replace(path.find('.'), path.find('.', path.find('.') + 1) - path.find('.'), " *");
    if (std::ranges::find(paths, path) == paths.end()) paths.push_back(std::move(path));
  }
  return fmt::format("{} by {}", fmt::join(paths, " "),
                     apply_names[static_cast<std::size_t>(dispersion.apply)]);
}

DrawLever lever_of(const Scene& scene, const Dispersion& dispersion, std::size_t column) {
  DrawLever draw{{{{column}, is_scaled(dispersion)},
                  plain_words(scene, dispersion),
                  {dispersion.name},
                  {},
                  ""},
                 quantity_of(scene, dispersion),
                 dispersion.targets};
  if (draw.lever.moved.scaled)
    draw.lever.paths = short_paths(scene, draw.targets);
  else if (!draw.targets.empty())
    draw.lever.unit = unit_of(draw.targets.front());
  return draw;
}

/// Levers of one quantity: each draw alone, then all together if there are several.
using Quantities = std::map<std::string, std::vector<DrawLever>>;

Quantities quantities_of(const Campaign& campaign, const Results& results) {
  Quantities quantities;
  for (const Dispersion& dispersion : campaign.dispersions) {
    const auto column = std::ranges::find(results.draws, dispersion.name, &Column::name);
    if (column == results.draws.end()) continue;
    DrawLever draw = lever_of(campaign.scene, dispersion,
                              static_cast<std::size_t>(column - results.draws.begin()));
    quantities[draw.quantity].push_back(std::move(draw));
  }
  for (auto& [name, draws] : quantities) {
    if (draws.size() < 2) continue;
    DrawLever all = draws.front();
    for (const DrawLever& each : std::span(draws).subspan(1)) {
      all.lever.moved.columns.push_back(each.lever.moved.columns.front());
      all.lever.moved.scaled = all.lever.moved.scaled && each.lever.moved.scaled;
      all.lever.draws.push_back(each.lever.draws.front());
      all.targets.insert(all.targets.end(), each.targets.begin(), each.targets.end());
    }
    all.lever.words = plain_words(campaign.scene, all.targets);
    if (all.lever.moved.scaled) all.lever.paths = short_paths(campaign.scene, all.targets);
    draws.push_back(std::move(all));
  }
  return quantities;
}

/// The size of a change: |log| of a factor; a shift divided by |mean| or by half the range drawn, whichever is larger.
double size_of(const Lever& lever, const NeededChange& change) {
  if (lever.moved.scaled) return change.change > 0 ? std::abs(std::log(change.change)) : 1e9;
  const double half = (change.most - change.least) / 2;
  return std::abs(change.change) / std::max(std::abs(change.now), half);
}

/// The lever to name for a quantity: all draws together, or the best one alone.
std::optional<LeverChange> best_of(std::span<const DrawLever> draws,
                                   std::span<const std::optional<NeededChange>> changes) {
  const std::size_t single = draws.size() > 1 ? draws.size() - 1 : 1;
  std::optional<LeverChange> best;
  const auto rank = [](const Lever& lever, const NeededChange& change) {
    return std::pair(!change.known, size_of(lever, change));
  };
  for (std::size_t k = 0; k < single; ++k)
    if (changes[k] &&
        (!best || rank(draws[k].lever, *changes[k]) < rank(best->lever, best->change)))
      best = LeverChange{draws[k].lever, *changes[k]};
  if (draws.size() == 1 || !changes.back()) return best;
  const LeverChange all{draws.back().lever, *changes.back()};
  const bool alone =
      best && best->change.known >= all.change.known &&
      size_of(best->lever, best->change) <= alone_at_most * size_of(all.lever, all.change);
  return alone ? best : std::optional(all);
}

} // namespace

std::optional<LeverChanges> lever_changes(NeededFor what, const Campaign& campaign,
                                          const Verdict& verdict, const Results& results,
                                          const Replication& replication, double confidence,
                                          std::size_t most) {
  const Quantities quantities = quantities_of(campaign, results);
  std::vector<MovedDraws> moved;
  for (const auto& [name, draws] : quantities)
    for (const DrawLever& draw : draws) moved.push_back(draw.lever.moved);
  const auto needed = needed_changes(what, verdict, results, replication, moved, confidence);
  if (!needed) return std::nullopt;
  LeverChanges found{what, needed->runs, needed->explained, {}};
  if (what == NeededFor::limit && !(needed->explained >= least_explained)) return found;
  std::span<const std::optional<NeededChange>> rest = needed->changes;
  for (const auto& [name, draws] : quantities) {
    if (auto best = best_of(draws, rest.first(draws.size())); best)
      found.levers.push_back(std::move(*best));
    rest = rest.subspan(draws.size());
  }
  std::ranges::stable_sort(found.levers, {}, [](const LeverChange& each) {
    return std::pair(!each.change.known, size_of(each.lever, each.change));
  });
  found.levers.resize(std::min(found.levers.size(), most));
  return found;
}

} // namespace wingspread
