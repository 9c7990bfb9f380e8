#include "montecarlo/analyses/fit/fit_campaign.hpp"

#include "distributions/prepared_distribution.hpp"
#include "distributions/random_stream.hpp"
#include "montecarlo/foundation/formats/nearest.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/distribution_json.hpp"
#include "montecarlo/model/campaign/wanted_correlations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

namespace wingspread {
namespace {

bool has(const std::vector<std::size_t>& list, std::size_t index) {
  return std::ranges::find(list, index) != list.end();
}

/// The keys that say what the draws of a dispersion change: the same for a column of rows and for a dispersion.
Json effect_of(const Json& entry, const Dispersion& dispersion, const Scene& scene) {
  if (entry.contains("through")) return {{"through", entry["through"]}};
  return {{"to", paths_of(scene, dispersion.targets)}, {"apply", entry["apply"]}};
}

/// Whether it makes a difference which of two dispersions acts first.
bool order_matters(const Dispersion& one, const Dispersion& other) {
  bool matters = false;
  for_each_effect(one, [&](Apply how, const auto& targets, const Curve*) {
    for_each_effect(other, [&](Apply then, const auto& others, const Curve*) {
      const auto is_shared = [&](const SceneParameter& each) {
        return std::ranges::find(others, each) != others.end();
      };
      matters = matters ||
                ((how != then || how == Apply::set) && std::ranges::any_of(targets, is_shared));
    });
  });
  return matters;
}

/// Two dispersions of which the order would change, the first not fitted, the second fitted.
struct LostOrder {
  std::size_t other, fitted;
};

/// A list of dispersions with one entry for all fitted ones.
class FittedList {
public:
  FittedList(const Campaign& campaign, const std::vector<std::size_t>& fitted)
      : campaign_(campaign), fitted_(fitted) {
    const Json& entries = campaign.resolved.at("dispersions");
    std::vector<std::vector<std::size_t>> drawn(entries.size()); // by each entry
    for (std::size_t i = 0; i < campaign.dispersions.size(); ++i)
      drawn[entry_of(campaign, campaign.dispersions[i])].push_back(i);
    for (std::size_t k = 0; k < entries.size(); ++k) add(entries[k], drawn[k]);
    find_place();
  }

  /// Nothing if all dispersions that change the same parameter keep their order.
  [[nodiscard]] const std::optional<LostOrder>& lost() const { return lost_; }

  [[nodiscard]] Json json() const {
    std::string name = "fitted";
    const auto is_name = [&](const Dispersion& dispersion) { return dispersion.name == name; };
    while (std::ranges::any_of(campaign_.dispersions, is_name)) name += "_";
    Json list = list_;
    const Json rows{{"file", posterior_file}, {"apply", "scale"}, {"columns", columns_}};
    list.insert(list.begin() + static_cast<std::ptrdiff_t>(place_),
                Json{{"name", name}, {"rows", rows}});
    return list;
  }

private:
  void add(const Json& entry, const std::vector<std::size_t>& drawn) {
    const auto is_fitted = [&](std::size_t i) { return has(fitted_, i); };
    if (std::ranges::none_of(drawn, is_fitted)) {
      list_.push_back(entry);
      drawn_.push_back(drawn);
      return;
    }
    if (columns_.empty()) place_ = list_.size();
    for (const std::size_t i : drawn) {
      const Dispersion& dispersion = campaign_.dispersions[i];
      Json effect = effect_of(entry, dispersion, campaign_.scene);
      if (has(fitted_, i)) {
        columns_[dispersion.name] = std::move(effect);
      } else {
        effect["name"] = dispersion.name;
        effect["distribution"] = write_distribution(dispersion.distribution);
        list_.push_back(std::move(effect));
        drawn_.push_back({i});
      }
    }
  }

  /// The fitted ones act together: behind all that act before one of them, and before all that act after one. Where the
  /// order makes no difference, at the place of the first.
  void find_place() {
    std::size_t least = 0, most = list_.size();
    LostOrder last{};
    for (std::size_t k = 0; k < list_.size(); ++k)
      for (const std::size_t i : drawn_[k])
        for (const std::size_t j : fitted_) {
          if (!order_matters(campaign_.dispersions[i], campaign_.dispersions[j])) continue;
          if (i < j) least = k + 1, last = {i, j};
          if (i > j) most = std::min(most, k);
        }
    if (least > most) lost_ = last;
    place_ = std::max(std::min(place_, most), least);
  }

  const Campaign& campaign_;
  const std::vector<std::size_t>& fitted_;
  Json list_ = Json::array(), columns_ = Json::object();
  std::vector<std::vector<std::size_t>> drawn_; ///< by each of list_
  std::size_t place_ = 0;
  std::optional<LostOrder> lost_;
};

/// A case's laws without those of fitted dispersions; of an `each` of which some are fitted, each other copy gets it.
Json laws_of_others(const Campaign& campaign, const std::vector<std::size_t>& fitted,
                    const Json& laws) {
  Json others = Json::object();
  for (const auto& [name, law] : laws.items()) {
    bool any = false;
    Json copies = Json::object();
    for (std::size_t i = 0; i < campaign.dispersions.size(); ++i)
      if (const Dispersion& each = campaign.dispersions[i]; is_drawn_by(campaign, name, each)) {
        any = any || has(fitted, i);
        if (!has(fitted, i)) copies[each.name] = law;
      }
    if (any)
      others.update(copies);
    else
      others[name] = law;
  }
  return others;
}

} // namespace

Campaign campaign_of_test(const Campaign& campaign, const CaseSpec* of_case) {
  Campaign base = of_case ? campaign_of_case(campaign, *of_case) : campaign;
  for (const char* key : {"cases", "requirements", "until", "margin", "motorization"})
    base.resolved.erase(key);
  base.resolved["statistics"].erase("tolerance");
  return base;
}

void add_measured(const JsonCursor& at, const std::string& name, const Scene& scene,
                  Outputs& outputs) {
  std::vector<std::string> known;
  for (const OutputColumn& column : output_columns(scene, all_outputs()))
    known.push_back(column.name);
  if (std::ranges::find(known, name) != known.end()) {
    if (const auto family = family_of(name)) outputs.insert(*family);
    return;
  }
  constexpr std::array<std::string_view, 5> words{deployed_output, "status", "reason",
                                                  "latch_order", "peaks_final"};
  if (std::ranges::find(words, name) != words.end())
    at.refuse(fmt::format("\"{}\", which is no number", name),
              fmt::format("a number that a test measures, such as \"{}\": a time, a rate, a "
                          "moment, a force, an angle or a frequency of montecarlo/OUTPUTS.md",
                          known.front()));
  else
    at.refuse(fmt::format("\"{}\"", name), "an output of the scene" + did_you_mean(name, known));
}

std::vector<std::size_t> with_other_law(const Campaign& test, const Campaign& campaign,
                                        const std::vector<std::size_t>& dispersions) {
  const auto law = [](const Campaign& of, std::size_t i) {
    return write_distribution(of.dispersions[i].distribution);
  };
  std::vector<std::size_t> found;
  for (const std::size_t i : dispersions)
    if (law(test, i) != law(campaign, i)) found.push_back(i);
  return found;
}

Json predicting_campaign(const Campaign& campaign, const std::vector<std::size_t>& fitted) {
  Json json = campaign.resolved;
  json["dispersions"] = FittedList(campaign, fitted).json();
  if (json.contains("correlations")) {
    std::vector<RankCorrelation> kept = campaign.wanted_correlations;
    std::erase_if(kept, [&](const RankCorrelation& pair) {
      return has(fitted, pair.first) || has(fitted, pair.second);
    });
    json["correlations"] = write_wanted_correlations(kept, campaign.dispersions);
  }
  if (json.contains("cases"))
    for (Json& each : json["cases"])
      if (each.contains("distributions"))
        each["distributions"] = laws_of_others(campaign, fitted, each["distributions"]);
  json["sampling"].erase("extended_from"); // new laws, not analysed before
  json.erase(stamp_key);
  return json;
}

std::vector<std::string> lost_laws(const Campaign& campaign,
                                   const std::vector<std::size_t>& fitted) {
  std::vector<std::string> lost;
  for (const CaseSpec& spec : campaign.cases)
    for (const CaseDistribution& law : spec.distributions)
      for (const std::size_t i : fitted)
        if (is_drawn_by(campaign, law.dispersion, campaign.dispersions[i]))
          lost.push_back(fmt::format("{}: {}", spec.name, campaign.dispersions[i].name));
  return lost;
}

std::vector<std::size_t> posterior_parameters(const ParameterSpace& space) {
  std::vector<std::size_t> parameters;
  for (std::size_t k = 0; k < space.size(); ++k) {
    const FitParameter& parameter = space.list()[k];
    const bool is_new_unit = // its draw takes the place of the first test's own value
        parameter.kind == FitParameter::Kind::dispersion && parameter.test == 0 &&
        std::ranges::find(space.dependent(), parameter.dispersion) != space.dependent().end();
    if (k < space.common() || is_new_unit) parameters.push_back(k);
  }
  return parameters;
}

void refuse_lost_order(const Campaign& campaign, const ParameterSpace& space,
                       const std::string& file) {
  std::vector<std::size_t> fitted;
  for (const std::size_t k : posterior_parameters(space))
    fitted.push_back(space.list()[k].dispersion);
  const auto lost = FittedList(campaign, fitted).lost();
  if (!lost) return;
  const std::string& other = campaign.dispersions[lost->other].name;
  throw SpecError(
      {{file, "/fit/parameters",
        fmt::format("\"{}\", which changes the same parameter after \"{}\", which is not fitted",
                    campaign.dispersions[lost->fitted].name, other),
        fmt::format("\"{}\" fitted too, or before or behind all fitted ones in the campaign: the "
                    "written campaign draws these at one place",
                    other)}});
}

PosteriorRows posterior_rows(const Campaign& campaign, const ParameterSpace& space,
                             PhysicalValues& values, std::vector<FitPoint> points) {
  PosteriorRows all;
  const std::vector<std::size_t> columns = posterior_parameters(space);
  for (const std::size_t k : columns) {
    all.columns.push_back(space.list()[k].dispersion);
    all.names.push_back(campaign.dispersions[all.columns.back()].name);
  }
  const PreparedDistribution normal({Normal{}, std::nullopt});
  for (std::size_t n = 0; n < points.size(); ++n) {
    for (std::size_t c = space.common(); c < columns.size(); ++c)
      points[n][static_cast<Eigen::Index>(columns[c])] = normal.quantile(
          uniform(campaign.sampling.seed, n,
                  stream_name("\x7F" + all.names[c]))); // a control character: no draw's stream
    const std::vector<double> at = values.of_new_unit(points[n]);
    std::vector<double>& row = all.rows.emplace_back();
    for (const std::size_t k : columns) row.push_back(at[k]);
  }
  return all;
}

} // namespace wingspread
