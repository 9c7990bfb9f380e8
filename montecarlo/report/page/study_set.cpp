#include "montecarlo/report/page/study_set.hpp"

#include "montecarlo/analyses/fit/fit_report.hpp"
#include "montecarlo/analyses/margin/margin_report.hpp"
#include "montecarlo/analyses/rare/rare_report.hpp"
#include "montecarlo/analyses/sensitivity/design_folder.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/report/data/page_numbers.hpp"
#include "montecarlo/report/data/wing_json.hpp"
#include "montecarlo/report/page/fit_set.hpp"
#include "montecarlo/report/page/margin_block.hpp"
#include "montecarlo/report/page/static_margins_json.hpp"
#include "montecarlo/results/results_folder/results_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace wingspread {
namespace {

/// A set without runs.
Json empty_set(const std::filesystem::path& folder, const std::string& label, const Json& about) {
  Json json{{"label", label},
            {"folder", folder.string()},
            {"case", nullptr},
            {"campaign", ""},
            {"document", Json::object()},
            {"description", ""},
            {"foreign", false},
            {"seed", about.contains("seed") ? about["seed"].dump() : ""},
            {"hash", about.value("hash", "")},
            {"version", about.value("version", "")},
            {"runs", 0},
            {"planned", 0},
            {"partial", false},
            {"stopped", false},
            {"shard", nullptr},
            {"design", ""},
            {"confidence", nullptr},
            {"looks", 1},
            {"replicates", 0},
            {"made_by", ""},
            {"judged_by", ""}};
  for (const char* list : {"statuses", "reasons", "orders", "warnings", "requirements", "outputs",
                           "scatters", "motions", "wing_orders"})
    json[list] = Json::array();
  json["order_kinds"] = json["without_latch"] = 0;
  for (const char* block :
       {"accuracy", "correlations", "sensitivity", "wing", "envelopes", "static_margins", "modes",
        "margin", "rare", "kernel", "fit", "together"})
    json[block] = nullptr;
  json["inputs"] = {
      {"scene", Json::array()}, {"dispersions", Json::array()}, {"settings", Json::array()}};
  return json;
}

/// The confidence of a study's bounds.
/// @param otherwise of a study without one: older versions wrote none
/// @throws SpecError unless it is a number, > 0 and < 1
Json confidence_of(const Json& study, const std::filesystem::path& file, Json otherwise = nullptr) {
  if (!study.contains("confidence")) return otherwise;
  const Json& confidence = study["confidence"];
  if (!confidence.is_number() || !is_proper_share(confidence.get<double>()))
    throw SpecError(
        {{file.string(), "/confidence", describe_value(confidence), "a number, > 0 and < 1"}});
  return confidence;
}

/// Adds the scene's name, the case and the words of the first page, which studies write without their campaign; older
/// versions wrote none.
void add_origin(const Json& study, Json& set) {
  set["campaign"] = study.value("scene", "");
  set["case"] = study.value("case", Json(nullptr));
  const Json words = study.value("report", Json::object());
  for (const HeaderWord& word : header_words)
    if (words.contains(word.key)) set["document"][word.key] = words[word.key].get<std::string>();
}

void add_campaign(const Campaign& campaign, Json& set) {
  set["campaign"] = campaign.scene.name;
  if (!campaign.of_case.empty()) set["case"] = campaign.of_case;
  set["document"] = write_report_header(campaign.report);
  set["wing"] = wing_json(nominal_scene(campaign));
  set["static_margins"] = static_margins_json(campaign);
}

// ---- margin

std::vector<Json> margin_sets(const std::filesystem::path& folder, const std::string& label) {
  const Json study = parse_json_file(folder / margin_json_file);
  const MarginTable table = read_margin_csv(folder / margin_csv_file);
  const std::filesystem::path recommended = folder / recommended_file;
  std::vector<Json> sets;
  for (const Json& search : study.at("searches")) {
    const std::string name = search.at("name");
    Json set = empty_set(folder, study["searches"].size() > 1 ? label + " · " + name : label,
                         study.value(stamp_key, Json::object()));
    add_origin(study, set);
    if (std::filesystem::exists(recommended)) {
      const Campaign campaign = read_campaign_file(recommended);
      add_campaign(campaign, set);
      set["confidence"] = campaign.statistics.confidence; // older versions write it only there
    }
    set["confidence"] = confidence_of(study, folder / margin_json_file, set["confidence"]);
    set["margin"] = margin_block(search, table, set["confidence"]);
    set["warnings"] = study.value("warnings", Json::array());
    sets.push_back(std::move(set));
  }
  return sets;
}

// ---- Sobol' indices

Json sobol_effects(const Json& sensitivity, std::size_t most) {
  Json effects = Json::array();
  for (const auto& [name, output] : sensitivity.at("outputs").items()) {
    std::vector<Json> of_output;
    for (const auto& [draw, effect] : output.at("dispersions").items()) {
      Json json{{"output", name}, {"draw", draw}};
      for (const char* index : {"first", "total"}) {
        const Json& value = effect.at(index);
        json[index] = value.at("value");
        json[std::string(index) + "_lower"] = value.at("lower");
        json[std::string(index) + "_upper"] = value.at("upper");
      }
      if (!json["total"].is_null()) of_output.push_back(std::move(json));
    }
    std::ranges::stable_sort(of_output, std::ranges::greater{},
                             [](const Json& effect) { return effect["total"].get<double>(); });
    for (Json& effect : std::span(of_output).first(std::min(most, of_output.size())))
      effects.push_back(std::move(effect));
  }
  return effects;
}

Json sobol_set(const std::filesystem::path& folder, const std::string& label) {
  constexpr std::size_t most_effects = 12;
  const SaltelliDesign design = read_design(folder);
  if (!std::filesystem::exists(folder / sensitivity_json_file))
    throw SpecError({{folder.string(), "",
                      fmt::format("no {}: {}", sensitivity_json_file,
                                  design.shard ? describe(design.shard) + " of a design"
                                               : "an unfinished design"),
                      design.shard ? "the folder into which `wingspread merge` merges all shards"
                                   : "a finished one: the command that made it, with --resume, "
                                     "goes on"}});
  const Json sensitivity = parse_json_file(folder / sensitivity_json_file);
  Json set = empty_set(folder, label, stamp_json(stamp_of(design)));
  add_campaign(design.campaign, set);
  set["confidence"] = confidence_of(sensitivity, folder / sensitivity_json_file);
  set["warnings"] = sensitivity.value("warnings", Json::array()); // older versions have none
  set["sensitivity"] = {{"kind", "sobol"}, {"effects", sobol_effects(sensitivity, most_effects)}};
  return set;
}

// ---- rare events

Json levels_json(const Json& repeat) {
  Json levels = Json::array();
  double probability = 1;
  for (const Json& level : repeat.at("levels")) {
    probability *= level.at("share").get<double>();
    levels.push_back(
        {{"threshold", level.at("threshold")}, {"probability", page_number(probability)}});
  }
  return levels;
}

/// The levels of every repeat.
Json repeats_json(const Json& repeats) {
  Json json = Json::array();
  for (const Json& repeat : repeats) json.push_back(levels_json(repeat));
  return json;
}

/// The strata of a rare event, the largest part of the sum first.
Json strata_json(const Json& study) {
  constexpr std::size_t most = 12;
  std::vector<Json> strata;
  const Json listed = study.value("strata", Json(nullptr)); // null, or of an earlier version: none
  for (const Json& part : listed.is_null() ? Json::array() : listed) {
    // Of a plain sample without the event (`reached`, for its bounds hold) the upper bound says more than the share 0.
    const bool hit = part.at("reached").get<bool>() && part.at("event").get<double>() > 0;
    strata.push_back({{"text", part.at("draws")},
                      {"probability", page_number(part.at("probability").get<double>(), 6)},
                      {"event", page_number(part.at(hit ? "event" : "upper").get<double>(), 6)},
                      {"reached", hit}});
  }
  std::ranges::stable_sort(strata, std::ranges::greater{}, [](const Json& part) {
    return part["probability"].get<double>() * part["event"].get<double>();
  });
  strata.resize(std::min(strata.size(), most));
  return strata;
}

/// Whether `rare` calls the upper bound of its strata an estimate. If runs with the event were found: where the strata without
/// any could add more than a hundredth to the sum (`reached` is false). Else: where a stratum was not reached.
bool has_estimated_bound(const Json& study) {
  if (study.at("lower").get<double>() > 0) return !study.at("reached").get<bool>();
  const Json strata = study.value("strata", Json(nullptr));
  return std::any_of(strata.begin(), strata.end(),
                     [](const Json& part) { return !part.at("reached").get<bool>(); });
}

Json rare_set(const std::filesystem::path& folder, const std::string& label) {
  const Json study = parse_json_file(folder / rare_json_file);
  Json set = empty_set(folder, label, study.value(stamp_key, Json::object()));
  add_origin(study, set);
  set["confidence"] = confidence_of(study, folder / rare_json_file);
  Json likeliest = nullptr;
  if (const Json& run = study.at("likeliest"); !run.is_null()) {
    std::vector<Json> draws;                               // largest deviation first
    const Json units = run.value("units", Json::object()); // older versions have none
    for (const auto& [name, value] : run.at("draws").items())
      draws.push_back({{"name", name},
                       {"value", value},
                       {"unit", units.value(name, "")},
                       {"z", run.at("z").at(name)}});
    std::ranges::stable_sort(draws, std::ranges::greater{},
                             [](const Json& draw) { return std::abs(draw["z"].get<double>()); });
    likeliest = {{"distance", run.at("distance")}, {"draws", draws}};
  }
  set["rare"] = {{"text", study.at("event")},
                 {"beyond", study.value("beyond", Json(nullptr))},
                 {"case", study.value("case", Json(nullptr))},
                 {"confidence", set["confidence"]},
                 {"probability", study.at("probability")},
                 {"lower", study.at("lower")},
                 {"upper", study.at("upper")},
                 {"reached", study.at("reached")},
                 {"bias", study.value("bias", Json(nullptr))},
                 {"estimated", has_estimated_bound(study)},
                 {"levels", repeats_json(study.at("repeats"))},
                 {"warnings", study.value("warnings", Json::array())},
                 {"strata", strata_json(study)},
                 {"likeliest", std::move(likeliest)}};
  return set;
}

Json fit_study_set(const std::filesystem::path& folder, const std::string& label) {
  const Json study = parse_json_file(folder / fit_json_file);
  Json set = empty_set(folder, label, study.value(stamp_key, Json::object()));
  add_origin(study, set);
  set["confidence"] = confidence_of(study, folder / fit_json_file, fit_confidence);
  std::optional<Campaign> campaign;
  if (const auto path = folder / campaign_file; std::filesystem::exists(path))
    add_campaign(campaign.emplace(read_campaign_file(path)), set);
  set["fit"] = fit_block(folder, campaign ? &campaign->scene : nullptr);
  return set;
}

/// Calls `read`, and names the folder in its errors.
template <class Read> auto reading(const std::filesystem::path& folder, Read read) {
  try {
    return read();
  } catch (const Json::exception& error) {
    throw SpecError(
        {{folder.string(), "", error.what(), "unchanged files of the command that wrote them"}});
  } catch (const std::out_of_range&) {
    throw SpecError({{folder.string(), "", "a column that is missing",
                      "unchanged files of the command that wrote them"}});
  }
}

} // namespace

bool is_study_folder(const std::filesystem::path& folder) {
  if (std::filesystem::exists(folder / fit_json_file))
    return true; // with a campaign for the prediction
  if (std::filesystem::exists(folder / campaign_file)) return false;
  return std::filesystem::exists(folder / margin_json_file) ||
         std::filesystem::exists(folder / design_file) ||
         std::filesystem::exists(folder / rare_json_file);
}

std::vector<Json> study_sets_json(const std::filesystem::path& folder, const std::string& label) {
  return reading(folder, [&]() -> std::vector<Json> {
    if (std::filesystem::exists(folder / margin_json_file)) return margin_sets(folder, label);
    if (std::filesystem::exists(folder / design_file)) return {sobol_set(folder, label)};
    if (std::filesystem::exists(folder / fit_json_file)) return {fit_study_set(folder, label)};
    return {rare_set(folder, label)};
  });
}

} // namespace wingspread
