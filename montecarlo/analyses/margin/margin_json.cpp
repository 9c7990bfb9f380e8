#include "montecarlo/analyses/margin/margin_report.hpp"
#include "montecarlo/analyses/margin/recommendation.hpp"
#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/results/summary/verdict_json.hpp"

namespace wingspread {
namespace {

/// A requirement's verdict in a case at a scale.
Json case_verdict_json(const Verdict& verdict, const std::string& which_case) {
  Json json{{"case", which_case}};
  json.update(write_requirements({&verdict.requirement, 1}).front());
  json["verdict"] = to_string(verdict.decision);
  json["disproved"] = verdict.disproved;
  json.update(evidence_json(verdict));
  return json;
}

/// The JSON of one search.
class SearchJson {
public:
  SearchJson(const MarginReport& report, const MarginSearch& search)
      : report_(report), search_(search), by_scale_(failing_by_scale(search)),
        conditions_(condition_findings(report.campaign, report.result, search)) {}

  [[nodiscard]] Json json() const {
    const auto windows = windows_of(by_scale_);
    const Window* best = widest(windows);
    Json json{{"name", search_.name},
              {"scales", paths_of(report_.campaign.scene, search_.scaled)},
              {"of_springs", search_.of_springs},
              {"looks", by_scale_.size()},
              {"looked_at", {by_scale_.begin()->first, by_scale_.rbegin()->first}}};
    json["window"] = best ? window(*best) : Json(nullptr);
    json["other_windows"] = Json::array();
    for (const Window& other : windows)
      if (&other != best) json["other_windows"].push_back(window(other));
    json["closed_by"] = Json::array();
    for (const std::size_t condition : closed_by(by_scale_))
      json["closed_by"].push_back(name(condition));
    json["recommended"] = recommended();
    json["why_none"] = search_.recommended ? Json(nullptr) : Json(why_withheld(search_));
    json["passed_over"] = passed_over();
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
    const ConditionFinding& found = conditions_[condition];
    return case_verdict_json(verdict_of(search_.seen.at(scale), found.condition), found.which_case);
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
    const auto [from, to] = widest_gap(search_, window);
    return {{"lower", edge(lower_edge(search_, window))},
            {"widest_gap", {{"from", from}, {"to", to}}},
            {"upper", edge(upper_edge(search_, window))},
            {"joint_confidence", window_confidence(report_.campaign, report_.result, window)}};
  }

  [[nodiscard]] Json verdicts(const ScaleResult& cases) const {
    Json json = Json::array();
    for (std::size_t which = 0; which < cases.size(); ++which)
      for (const Verdict& verdict : cases[which].verdicts)
        json.push_back(case_verdict_json(verdict, report_.result.cases[which].name));
    return json;
  }

  [[nodiscard]] static Json lowered(const Shortfall& each) {
    return {{"drive", each.drive},
            {"margin", margin_kind_names[static_cast<std::size_t>(each.kind)]},
            {"at_1", json_number(each.present)},
            {"at_scale", json_number(each.margin)}};
  }

  [[nodiscard]] Json given_up() const {
    Json json{{"requirements", Json::array()}, {"static_margins", Json::array()}};
    for (const Concession& each : concessions(report_.campaign, report_.result, search_)) {
      Json entry = name(each.condition);
      entry["at_1"] = evidence(each.condition, 1);
      entry["at_scale"] = evidence(each.condition, *search_.recommended);
      entry["at_1"]["quantile_over_runs"] = json_number(each.present_quantile);
      entry["at_scale"]["quantile_over_runs"] = json_number(each.quantile);
      json["requirements"].push_back(std::move(entry));
    }
    for (const Shortfall& each :
         lowered_margins(report_.result.campaigns, search_.scaled, *search_.recommended))
      json["static_margins"].push_back(lowered(each));
    return json;
  }

  [[nodiscard]] Json passed_over() const {
    if (!search_.passed_over) return nullptr;
    Json json = lowered(*search_.passed_over);
    json["scale"] = search_.passed_over->scale;
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
            {"as_good", {{"from", search_.as_good.lower}, {"to", search_.as_good.upper}}},
            {"rule", rule_of(search_)},
            {"strain", strain(search_.seen.at(scale))},
            {"most_strained", name(most_strained(search_.seen.at(scale)))},
            {"given_up", given_up()},
            {"verdicts", verdicts(search_.seen.at(scale))},
            {"confirmation",
             {{"seed", report_.result.confirmation_seed},
              {"passes", is_confirmed(search_)},
              {"joint_confidence", is_confirmed(search_) ? Json(confirmation_confidence(
                                                               report_.campaign, report_.result))
                                                         : Json()},
              {"verdicts", verdicts(*search_.confirmation)}}}};
  }

  /// The present springs (scale 1); null if scale 1 was not evaluated.
  [[nodiscard]] Json present() const {
    const auto found = by_scale_.find(1);
    if (found == by_scale_.end()) return nullptr;
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
  FailingByScale by_scale_;
  std::vector<ConditionFinding> conditions_;
};

Json definitions() {
  return {
      {"confidence",
       "at the top: of deployed_lower and deployed_upper in margin.csv, two-sided; elsewhere a "
       "requirement's own"},
      {"scale", "factor on the parameters in \"scales\", after all dispersion; the same draws at "
                "every scale"},
      {"window", "the widest stretch of scales at which every requirement is shown in every case"},
      {"edge", "the outermost scale that passes; what sets it fails at fails_at, within the "
               "tolerance; range_end: nothing fails up to where the search ended, at the limit to "
               "which the range may be widened: no edge"},
      {"widest_gap", "neighbouring scales of the window, furthest apart by ratio: nothing was run "
                     "between them, and what fails only there is not seen"},
      {"as_well", "further requirements that fail there because the same runs do not deploy"},
      {"verdict", "over all runs, one-sided: P(Bin(n, 1 - p) <= failures) <= 1 - c; what did not "
                  "deploy or happen counts against it; disproved: the opposite is shown"},
      {"recommended",
       "the scale of the window with the least strain; none where an edge was not found; "
       "confirmed by draws of a seed of its own"},
      {"as_good",
       "the scales around the recommended one with the same strain, ends within the tolerance"},
      {"rule", "of several scales as good the present springs, if they are among them, else the "
               "geometric mean of the ends"},
      {"strain", "of the requirement that is worst off: runs that break it over n (1 - p)"},
      {"given_up",
       "against the present springs (scale 1): requirements that more runs break or whose "
       "quantile over the runs with a value is nearer to its limit, and static margins that are "
       "lower"},
      {"passed_over",
       "a scale of less strain that is not advised: static margins would be negative"},
      {"joint_confidence",
       "at least this for all requirements in all cases together, each verdict's "
       "own being its requirement's: 1 - the sum of (1 - c), of a window over both "
       "of its edges; null of a confirmation that failed"},
      {"runs",
       "go as far as the requirements need: where none is about a peak they end at the last "
       "latch, so that one which fails after it counts as deployed here and as failed in "
       "wingspread run"},
      {"out_of_order", "draws that break a requirement at a scale, though not at one further out; "
                       "where there are none, the edge holds at the requirement's confidence"},
      {"ecss", "0.8 T / T_min - 1 at the least over the travel (0.8: \"available\"), T_min = 2 (I, "
               "S, HM, FR, HY, HA, HD with their factors) + 1.25 TD + TL; >= 0 is enough"},
      {"nasa", "T / (FS_f sum T_f + FS_v sum T_v) - 1, static: without accelerations; >= 0 is "
               "enough"},
      {"nasa_one_spring_out",
       "the same with one spring lost and all factors 1: one hinge loses one of its equal springs, "
       "of hinges that loops keep together the one whose loss costs most; null without springs"},
      {"gevs",
       "T / (FS_known sum T_known + FS_variable sum T_variable) - 1; >= 0 is enough; aiaa: the "
       "same with factors of its own"},
      {"drive",
       "\"root+mid\": hinges that loops keep together, judged as one: torques times how far "
       "each turns for the first"},
      {"null", "margin: nothing resists, or no spring that could be lost"}};
}

} // namespace

Json margin_json(const MarginReport& report, const Json& about) {
  const MarginSpec& spec = *report.campaign.margin;
  Json cases = Json::array(), searches = Json::array();
  for (const MarginCase& each : report.result.cases) cases.push_back(each.name);
  for (const MarginSearch& search : report.result.searches)
    searches.push_back(SearchJson(report, search).json());
  Json json{{stamp_key, about},
            {"scene", report.campaign.scene.name},
            {"met", is_met(report.result)},
            {"warnings", margin_warnings(report.result)},
            {"runs_per_scale", report.campaign.sampling.runs},
            {"runs", report.result.runs},
            {"runs_failed", report.result.failed},
            {"range", {spec.lower, spec.upper}},
            {"widest", {spec.lowest, spec.highest}},
            {"tolerance", spec.edge_tolerance},
            {"confidence", report.campaign.statistics.confidence},
            {"mode", margin_mode_names[static_cast<std::size_t>(spec.mode)]},
            {"cases", cases},
            {"searches", searches},
            {"motorization", static_margins_json(report.static_margins)},
            {"definitions", definitions()}};
  const std::string& of_case = report.campaign.of_case;
  json["case"] = of_case.empty() ? Json(nullptr) : Json(of_case);
  if (report.campaign.report != ReportHeader{})
    json["report"] = write_report_header(report.campaign.report);
  return json;
}

} // namespace wingspread
