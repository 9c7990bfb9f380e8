#include "montecarlo/report/data/inputs_json.hpp"

#include "distributions/prepared_distribution.hpp"
#include "montecarlo/model/campaign/describe.hpp"
#include "montecarlo/model/campaign/plain_words.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "montecarlo/model/scene_file/scene_parameter.hpp"
#include "montecarlo/report/data/page_numbers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace wingspread {
namespace {

/// The label of a path: "hinges.root.spring.torque_stowed" gives "root spring torque stowed".
std::string label_of(std::string path) {
  for (const char* kind : {"hinges.", "bodies.", "synchronisations."})
    if (path.starts_with(kind)) path.erase(0, std::string_view(kind).size());
  std::ranges::replace(path, '.', ' ');
  std::ranges::replace(path, '_', ' ');
  return path;
}

/// The parameters that are not 0 in either scene, with the case's value where it differs.
Json scene_json(const PageSource& source, std::size_t most) {
  const Scene &nominal = source.before_case.scene, &scene = source.stored.campaign.scene;
  Json json = Json::array();
  for (const std::string& path : parameter_paths(scene)) {
    const auto matches = resolve(scene, path).matches;
    if (matches.empty() || json.size() >= most) continue;
    const SceneParameter& parameter = matches.front().parameter;
    const double value = parameter.in(nominal), in_case = parameter.in(scene);
    if (value == 0 && in_case == 0) continue;
    json.push_back({{"path", path},
                    {"label", label_of(path)},
                    {"value", page_number(value)},
                    {"unit", unit_of(parameter)},
                    {"case_value", in_case == value ? Json(nullptr) : page_number(in_case)}});
  }
  return json;
}

/// The columns of a scene's tables, with their SI units.
constexpr std::array<std::pair<const char*, const char*>, 8> table_columns{
    {{"angle", "rad"},
     {"torque", "N·m"},
     {"deploying", "N·m"},
     {"stowing", "N·m"},
     {"time", "s"},
     {"rate", "rad/s"},
     {"travel", "rad"},
     {"travel_of_second", "rad"}}};

/// The columns of an object that is a table; else empty.
Json columns_of(const Json& object) {
  Json columns = Json::array();
  for (const auto& [name, unit] : table_columns)
    if (const auto found = object.find(name); found != object.end() && found->is_array())
      columns.push_back({{"name", name},
                         {"unit", unit},
                         {"values", page_numbers(found->get<std::vector<double>>())}});
  return columns;
}

/// Adds the tables below a value of the scene.
/// @param path of the value, with names in place of indices
void add_scene_tables(const Json& value, const std::string& path, std::size_t most, Json& tables) {
  if (tables.size() >= most || !value.is_structured()) return;
  if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i)
      if (value[i].is_object())
        add_scene_tables(value[i], path + "." + value[i].value("name", std::to_string(i)), most,
                         tables);
    return;
  }
  if (Json columns = columns_of(value); !columns.empty())
    tables.push_back({{"path", path}, {"columns", std::move(columns)}});
  for (const auto& [key, below] : value.items())
    add_scene_tables(below, path.empty() ? key : path + "." + key, most, tables);
}

/// The tables of a draw, with their values at its median.
Json tables_json(const Campaign& campaign, const Dispersion& dispersion, double median) {
  Json json = Json::array();
  for (const Driven& driven : dispersion.through) {
    std::vector<double> values;
    for (const double at : driven.table.knots()) values.push_back(driven.table.value_at(at));
    const bool scaled = driven.apply == Apply::scale;
    json.push_back({{"words", plain_words(campaign.scene, driven.targets)},
                    {"paths", short_paths(campaign.scene, driven.targets)},
                    {"apply", apply_names[static_cast<std::size_t>(driven.apply)]},
                    {"unit", scaled ? std::string_view() : unit_of(driven.targets.front())},
                    {"at", page_numbers(driven.table.knots())},
                    {"value", page_numbers(values)},
                    {"of_median", page_number(driven.table.value_at(median))}});
  }
  return json;
}

/// A dispersion: its law, the 1 % and 99 % quantiles of its draws, and its targets.
Json dispersion_json(const Campaign& campaign, const Dispersion& dispersion,
                     const Dispersion& before_case) {
  constexpr std::size_t most_paths = 20;
  const PreparedDistribution law(dispersion.distribution);
  Json paths = Json::array();
  std::optional<SceneParameter> first;
  std::string how;
  for_each_effect(dispersion, [&](Apply apply, const auto& targets, const Curve* table) {
    if (!first) {
      first = targets.front();
      how = table ? "by a table" : std::string(apply_names[static_cast<std::size_t>(apply)]);
    }
    for (const SceneParameter& target : targets)
      if (paths.size() < most_paths) paths.push_back(path_of(campaign.scene, target));
  });
  const std::string law_text = describe(dispersion.distribution),
                    before = describe(before_case.distribution);
  const double median = law.quantile(0.5);
  return {{"draw", dispersion.name},
          {"words", plain_words(campaign.scene, dispersion)},
          {"median", page_number(median)},
          {"tables", tables_json(campaign, dispersion, median)},
          {"paths", std::move(paths)},
          {"apply", how},
          {"law", law_text},
          {"law_before_case", law_text == before ? Json(nullptr) : Json(before)},
          {"nominal", first ? page_number(first->in(campaign.scene)) : Json(nullptr)},
          {"nominal_unit", first ? unit_of(*first) : std::string_view()},
          {"low", page_number(law.quantile(0.01))},
          {"high", page_number(law.quantile(0.99))},
          {"unit", unit_of_draw(dispersion)}};
}

Json settings_json(const Campaign& campaign) {
  const Integration& how = campaign.integration;
  const Sampling& sampling = campaign.sampling;
  const StatisticsSpec& statistics = campaign.statistics;
  Json json = Json::array();
  const auto add = [&](const std::string& label, const std::string& value) {
    json.push_back({{"label", label}, {"value", value}});
  };
  add("method", how.method);
  add("relative tolerance", fmt::format("{:g}", how.rtol));
  add("absolute tolerance", fmt::format("{:g}", how.atol));
  add("latch", how.smoothing ? fmt::format("smoothed over {:g} rad", *how.smoothing) : "event");
  if (has_fixed_step(how.method)) add("step", fmt::format("{:g} s", how.step));
  add("trial steps of a run, at most", std::to_string(how.max_steps));
  add("end of a run, at the latest", fmt::format("{:g} s", how.t_end));
  add("design", std::string(design_names[static_cast<std::size_t>(sampling.design)]));
  add("runs", std::to_string(sampling.runs));
  add("seed", std::to_string(sampling.seed));
  if (has_replicates(sampling)) add("replicates", std::to_string(sampling.replicates));
  add("confidence of bounds", fmt::format("{:g} %", 100 * statistics.confidence));
  add("quantiles", fmt::format("{:g}", fmt::join(statistics.quantiles, ", ")));
  for (const RankCorrelation& wanted : campaign.wanted_correlations) {
    const auto& [one, other] = std::minmax(campaign.dispersions[wanted.first].name,
                                           campaign.dispersions[wanted.second].name);
    add(fmt::format("rank correlation {}, {}", one, other), fmt::format("{:g}", wanted.spearman));
  }
  return json;
}

} // namespace

Json inputs_json(const PageSource& source, const PageDetail& detail) {
  constexpr std::size_t most_tables = 100;
  const Campaign& campaign = source.stored.campaign;
  Json dispersions = Json::array();
  for (std::size_t i = 0; i < campaign.dispersions.size(); ++i)
    dispersions.push_back(
        dispersion_json(campaign, campaign.dispersions[i], source.before_case.dispersions[i]));
  Json tables = Json::array();
  add_scene_tables(write_scene(campaign.scene), "", most_tables, tables);
  return {{"scene", scene_json(source, detail.parameters)},
          {"tables", std::move(tables)},
          {"dispersions", std::move(dispersions)},
          {"settings", settings_json(campaign)}};
}

} // namespace wingspread
