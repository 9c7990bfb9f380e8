#include "montecarlo/formats/json.hpp"
#include "montecarlo/margin/margin_report.hpp"
#include "montecarlo/runs/run_plan.hpp"

#include <algorithm>
#include <cmath>

namespace wingspread {
namespace {

/// A requirement's verdict in a case at a scale.
Json verdict_json(const Verdict& verdict, const std::string& which_case) {
  Json json{{"case", which_case}};
  json.update(write_requirements({&verdict.requirement, 1}).front());
  json["verdict"] = to_string(verdict.decision);
  json["disproved"] = verdict.disproved;
  json["failures"] = {{"seen", verdict.broken.size()},
                      {"allowed", verdict.allowed ? Json(*verdict.allowed) : Json(nullptr)}};
  json["observed"] = {{"share", json_number(verdict.share)}};
  json["guaranteed"] = {{"share", json_number(verdict.guaranteed_share)}};
  if (verdict.requirement.output != deployed_output) {
    json["observed"]["value"] = json_number(verdict.observed);
    json["guaranteed"]["value"] = json_number(verdict.guaranteed);
  }
  return json;
}

/// What was seen of one search.
class SearchJson {
public:
  SearchJson(const MarginReport& report, const MarginSearch& search)
      : report_(report), search_(search), looks_(looks_of(search)),
        conditions_(conditions(report, search)),
        numbers_(conditions_of(report.campaign, report.result)) {}

  [[nodiscard]] Json json() const {
    const auto windows = windows_of(looks_);
    const Window* best = widest(windows);
    Json json{{"name", search_.name},
              {"scales", paths_of(report_.campaign.scene, search_.scaled)},
              {"looks", looks_.size()}};
    json["window"] = best ? window(*best) : Json(nullptr);
    json["other_windows"] = Json::array();
    for (const Window& other : windows)
      if (&other != best) json["other_windows"].push_back(window(other));
    json["closed_by"] = Json::array();
    for (const std::size_t condition : closed_by(looks_))
      json["closed_by"].push_back(name(condition));
    json["recommended"] = recommended();
    json["present"] = present();
    json["requirements"] = requirements();
    return json;
  }

private:
  [[nodiscard]] Json name(std::size_t condition) const {
    return {{"requirement", conditions_[condition].requirement},
            {"case", conditions_[condition].which_case}};
  }

  [[nodiscard]] Json evidence(std::size_t condition, double scale) const {
    const auto& [which, requirement] = numbers_[condition];
    return verdict_json(search_.seen.at(scale)[which].verdicts[requirement],
                        conditions_[condition].which_case);
  }

  [[nodiscard]] Json edge(const MarginEdge& edge) const {
    Json json{{"scale", edge.passing}, {"range_end", !edge.failing}};
    json["fails_at"] = json_number(edge.failing);
    json["set_by"] = Json::array();
    for (const std::size_t condition : edge.set_by) {
      Json set_by = name(condition);
      set_by["passing"] = evidence(condition, edge.passing);
      set_by["failing"] = evidence(condition, *edge.failing);
      json["set_by"].push_back(std::move(set_by));
    }
    json["as_well"] = Json::array();
    for (const std::size_t condition : edge.as_well) json["as_well"].push_back(name(condition));
    return json;
  }

  [[nodiscard]] Json window(const Window& window) const {
    return {{"lower", edge(lower_edge(search_, window))},
            {"upper", edge(upper_edge(search_, window))}};
  }

  [[nodiscard]] Json verdicts(const ScaleLook& look) const {
    Json json = Json::array();
    for (std::size_t which = 0; which < look.size(); ++which)
      for (const Verdict& verdict : look[which].verdicts)
        json.push_back(verdict_json(verdict, report_.result.cases[which].name));
    return json;
  }

  [[nodiscard]] Json recommended() const {
    if (!search_.recommended) return nullptr;
    const double scale = *search_.recommended;
    Json values = Json::object();
    for (const SceneParameter& parameter : search_.scaled)
      values[path_of(report_.campaign.scene, parameter)] =
          scale * parameter.in(report_.campaign.scene);
    return {{"scale", scale},
            {"values", values},
            {"verdicts", verdicts(search_.seen.at(scale))},
            {"confirmation",
             {{"seed", report_.result.confirmation_seed},
              {"passes", is_confirmed(search_)},
              {"verdicts", verdicts(*search_.confirmation)}}}};
  }

  /// The springs as they are; null when the range does not have them.
  [[nodiscard]] Json present() const {
    const auto found = looks_.find(1);
    if (found == looks_.end()) return nullptr;
    Json failing = Json::array();
    for (const std::size_t condition : found->second) failing.push_back(evidence(condition, 1));
    return {{"passes", found->second.empty()}, {"failing", failing}};
  }

  [[nodiscard]] Json requirements() const {
    Json json = Json::array();
    for (std::size_t k = 0; k < conditions_.size(); ++k) {
      Json each = name(k);
      each["edges"] = conditions_[k].kind;
      each["holds"] = Json::array();
      for (const auto& [lower, upper, below, above] : conditions_[k].holds)
        each["holds"].push_back({{"from", lower},
                                 {"to", upper},
                                 {"fails_at", {json_number(below), json_number(above)}}});
      if (const auto& disorder = conditions_[k].out_of_order)
        each["out_of_order"] = {{"below", disorder->lower}, {"above", disorder->upper}};
      json.push_back(std::move(each));
    }
    return json;
  }

  const MarginReport& report_;
  const MarginSearch& search_;
  Looks looks_;
  std::vector<ConditionReport> conditions_;
  std::vector<MarginCondition> numbers_;
};

Json spread_json(const MarginSpread& spread, std::span<const double> probabilities) {
  Json quantiles = Json::array();
  for (std::size_t k = 0; k < spread.quantiles.size(); ++k)
    quantiles.push_back({{"p", probabilities[k]}, {"value", json_number(spread.quantiles[k])}});
  return {{"quantiles", quantiles},
          {"share_below_0", json_number(spread.share_short)},
          {"least", json_number(spread.least)},
          {"worst_run", spread.worst_run}};
}

Json draws_of_run(const Campaign& campaign, const RunPlan& plan, long run) {
  Json json = Json::object();
  std::vector<double> draws(campaign.dispersions.size());
  if (run < 0) return json;
  plan.draw(run, draws);
  for (std::size_t i = 0; i < draws.size(); ++i)
    json[campaign.dispersions[i].name] = json_number(draws[i]);
  return json;
}

/// A hinge's least margins over its travel, kind by kind.
Json hinge_json(const MarginReport& report, const RunPlan& plan, const HingeMotorization& each) {
  const Hinge& hinge = report.campaign.scene.hinges[each.hinge];
  Json json{{"hinge", hinge.name}};
  for (std::size_t kind = 0; kind < margin_kind_names.size(); ++kind) {
    Json entry{{"nominal", json_number(each.worst[kind])},
               {"angle", hinge.stowed + (hinge.latched - hinge.stowed) * each.worst_at[kind]}};
    entry["draws"] = spread_json(each.worst_spread[kind], report.campaign.statistics.quantiles);
    entry["draws"]["worst_draw"] =
        draws_of_run(report.campaign, plan, each.worst_spread[kind].worst_run);
    json[std::string(margin_kind_names[kind])] = std::move(entry);
  }
  return json;
}

Json motorization_json(const MarginReport& report) {
  const RunPlan plan(report.campaign);
  Json json{{"standards", {{"ecss", ecss_standard}, {"nasa", nasa_standard}}}};
  json["factors"] = write_margin(*report.campaign.margin, report.campaign.scene)["motorization"];
  json["springs_per_hinge"] = report.campaign.margin->springs_per_hinge;
  json["at"] = Json::array();
  for (const auto& [scale, study] : report.motorization) {
    Json hinges = Json::array();
    for (const HingeMotorization& each : study.hinges)
      hinges.push_back(hinge_json(report, plan, each));
    json["at"].push_back({{"scale", scale},
                          {"draws", study.draws},
                          {"invalid", study.invalid},
                          {"least_over_travel", hinges}});
  }
  return json;
}

Json definitions() {
  return {
      {"scale", "factor on the parameters in \"scales\", after all dispersion; the same draws at "
                "every scale"},
      {"window", "the widest stretch of scales at which every requirement is shown in every case"},
      {"edge", "the outermost scale that passes; what sets it fails at fails_at, within the "
               "tolerance; range_end: nothing fails up to the end of the range"},
      {"as_well", "what fails there by the same runs, which do not deploy"},
      {"verdict", "over all runs, one-sided: P(Bin(n, 1 - p) <= failures) <= 1 - c; what did not "
                  "deploy or happen counts against it; disproved: the opposite is shown"},
      {"recommended", "geometric mean of the edges"},
      {"out_of_order", "draws that break a requirement at a scale, though not at one further out; "
                       "where there are none, the edge holds at the requirement's confidence"},
      {"ecss", "0.8 T / T_min - 1 at the least over the travel (0.8: \"available\"), T_min = 2 (I, "
               "S, HM, FR, HY, HA, HD with their factors) + 1.25 TD + TL; >= 0 is enough"},
      {"nasa", "T / (FS_f sum T_f + FS_v sum T_v) - 1, static: without accelerations; >= 0 is "
               "enough"},
      {"nasa_one_spring_out",
       "the same with one of a hinge's equal springs lost and all factors 1"},
      {"null", "margin: nothing resists"}};
}

} // namespace

Json margin_json(const MarginReport& report, const Json& about) {
  const MarginSpec& spec = *report.campaign.margin;
  Json cases = Json::array(), searches = Json::array();
  for (const MarginCase& each : report.result.cases) cases.push_back(each.name);
  for (const MarginSearch& search : report.result.searches)
    searches.push_back(SearchJson(report, search).json());
  return {{stamp_key, about},
          {"scene", report.campaign.scene.name},
          {"met", is_met(report.result)},
          {"runs_per_scale", report.campaign.sampling.runs},
          {"runs", report.result.runs},
          {"runs_failed", report.result.failed},
          {"range", {spec.lower, spec.upper}},
          {"tolerance", spec.edge_tolerance},
          {"mode", margin_mode_names[static_cast<std::size_t>(spec.mode)]},
          {"cases", cases},
          {"searches", searches},
          {"motorization", motorization_json(report)},
          {"definitions", definitions()}};
}

} // namespace wingspread
