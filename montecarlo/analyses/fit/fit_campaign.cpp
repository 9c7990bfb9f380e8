#include "montecarlo/analyses/fit/fit_campaign.hpp"

#include "distributions/prepared_distribution.hpp"
#include "distributions/random_stream.hpp"
#include "montecarlo/foundation/formats/nearest.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/distribution_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace wingspread {
namespace {

bool has(const std::vector<std::size_t>& list, std::size_t index) {
  return std::ranges::find(list, index) != list.end();
}

/// Number of dispersions that an entry of the list becomes.
std::size_t count_of(const Json& entry, const Scene& scene) {
  std::vector<Problem> problems;
  const Json list = Json::array({entry});
  return read_dispersions(JsonCursor(list, "", problems), &scene, "").list.size();
}

/// The keys that say what the draws of a dispersion change: the same for a column of rows and for a dispersion.
Json effect_of(const Json& entry, const Dispersion& dispersion, const Scene& scene) {
  if (entry.contains("through")) return {{"through", entry["through"]}};
  return {{"to", paths_of(scene, dispersion.targets)}, {"apply", entry["apply"]}};
}

/// Whether a case's law for `name` is that of a fitted dispersion.
bool is_fitted_name(const Campaign& campaign, const std::vector<std::size_t>& fitted,
                    const std::string& name) {
  return std::ranges::any_of(fitted, [&](std::size_t i) {
    const std::string& own = campaign.dispersions[i].name;
    return own == name || own.starts_with(name + ".");
  });
}

Json dispersions_of(const Campaign& campaign, const std::vector<std::size_t>& fitted) {
  Json list = Json::array(), columns = Json::object();
  std::size_t next = 0, place = 0;
  bool placed = false;
  for (const Json& entry : campaign.resolved.at("dispersions")) {
    const std::size_t first = next;
    next += count_of(entry, campaign.scene);
    bool any = false;
    for (std::size_t i = first; i < next; ++i) any = any || has(fitted, i);
    if (any && !std::exchange(placed, true)) place = list.size();
    if (!any) list.push_back(entry);
    for (std::size_t i = first; any && i < next; ++i) {
      const Dispersion& dispersion = campaign.dispersions[i];
      Json effect = effect_of(entry, dispersion, campaign.scene);
      if (has(fitted, i)) {
        columns[dispersion.name] = std::move(effect);
      } else {
        effect["name"] = dispersion.name;
        effect["distribution"] = write_distribution(dispersion.distribution);
        list.push_back(std::move(effect));
      }
    }
  }
  std::string name = "fitted";
  const auto is_name = [&](const Dispersion& dispersion) { return dispersion.name == name; };
  while (std::ranges::any_of(campaign.dispersions, is_name)) name += "_";
  list.insert(list.begin() + static_cast<std::ptrdiff_t>(place),
              Json{{"name", name},
                   {"rows", {{"file", posterior_file}, {"apply", "scale"}, {"columns", columns}}}});
  return list;
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
  json["dispersions"] = dispersions_of(campaign, fitted);
  if (json.contains("correlations")) {
    Json kept = Json::array();
    for (const Json& pair : json["correlations"])
      if (!is_fitted_name(campaign, fitted, pair["between"][0].get<std::string>()) &&
          !is_fitted_name(campaign, fitted, pair["between"][1].get<std::string>()))
        kept.push_back(pair);
    json["correlations"] = std::move(kept);
  }
  if (json.contains("cases"))
    for (Json& each : json["cases"])
      if (each.contains("distributions")) {
        Json laws = Json::object();
        for (const auto& [name, law] : each["distributions"].items())
          if (!is_fitted_name(campaign, fitted, name)) laws[name] = law;
        each["distributions"] = std::move(laws);
      }
  json["sampling"].erase("extended_from"); // new laws, not analysed before
  json.erase(stamp_key);
  return json;
}

std::vector<std::string> lost_laws(const Campaign& campaign,
                                   const std::vector<std::size_t>& fitted) {
  std::vector<std::string> lost;
  for (const CaseSpec& spec : campaign.cases)
    for (const CaseDistribution& law : spec.distributions)
      if (is_fitted_name(campaign, fitted, law.dispersion))
        lost.push_back(fmt::format("{}: {}", spec.name, law.dispersion));
  return lost;
}

PosteriorRows posterior_rows(const Campaign& campaign, const ParameterSpace& space,
                             PhysicalValues& values, std::vector<FitPoint> points) {
  PosteriorRows all;
  std::vector<std::size_t> columns; // indices in the space
  for (std::size_t k = 0; k < space.size(); ++k) {
    const FitParameter& parameter = space.list()[k];
    const bool is_new_unit = // its draw takes the place of the first test's own value
        parameter.kind == FitParameter::Kind::dispersion && parameter.test == 0 &&
        std::ranges::find(space.dependent(), parameter.dispersion) != space.dependent().end();
    if (k >= space.common() && !is_new_unit) continue;
    columns.push_back(k);
    all.columns.push_back(parameter.dispersion);
    all.names.push_back(campaign.dispersions[parameter.dispersion].name);
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
