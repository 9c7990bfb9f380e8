#include "montecarlo/report/data/set_json.hpp"

#include "montecarlo/engine/runs/campaign_check.hpp"
#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/report/data/causes_json.hpp"
#include "montecarlo/report/data/envelopes_json.hpp"
#include "montecarlo/report/data/inputs_json.hpp"
#include "montecarlo/report/data/motions_json.hpp"
#include "montecarlo/report/data/output_json.hpp"
#include "montecarlo/report/data/page_numbers.hpp"
#include "montecarlo/report/data/wing_json.hpp"
#include "montecarlo/results/summary/summary_json.hpp"
#include "montecarlo/results/summary/warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace wingspread {
namespace {

/// The folder that the commands make from the folder of this set: each of the page's folders has another one.
std::string again(const PageSource& source) {
  return source.argument == 0 ? "again" : fmt::format("again{}", source.argument + 1);
}

/// The command that reproduces the rows.
std::string made_by(const PageSource& source) {
  const StoredCampaign& stored = source.stored;
  if (stored.foreign) return "";
  std::string text = fmt::format("wingspread run {} --seed {} --runs {}",
                                 shell_word((source.made_from / campaign_file).string()),
                                 stored.stamp.seed, stored.campaign.sampling.runs);
  for (const std::string& name : source.made_cases) text += " --case " + shell_word(name);
  if (const auto& shard = stored.stamp.shard)
    text += fmt::format(" --shard {}/{}", shard->index, shard->of);
  if (!source.has_rows()) text += " --no-rows";
  return text + " --out " + again(source);
}

/// The command that makes the page's statistics and verdicts from the rows of made_by's command; empty if that command
/// has made them.
std::string judged_by(const PageSource& source) {
  const StoredCampaign& stored = source.stored;
  const std::string options = analysis_options(source);
  if (options.empty() || stored.foreign) return "";
  return "wingspread analyze " + again(source) +
         (source.analyzed_alone ? "/" + stored.campaign.of_case : "") + options;
}

Json identity_json(const PageSource& source) {
  const StoredCampaign& stored = source.stored;
  const Campaign& campaign = stored.campaign;
  const auto& shard = stored.stamp.shard;
  return {{"label", source.label},
          {"folder", stored.folder.string()},
          {"case", campaign.of_case.empty() ? Json(nullptr) : Json(campaign.of_case)},
          {"campaign", campaign.scene.name},
          {"description", campaign.resolved.value("description", "")},
          {"foreign", stored.foreign},
          {"seed", std::to_string(stored.stamp.seed)},
          {"hash", stored.stamp.hash},
          {"version", stored.stamp.version},
          {"runs", source.summary.runs},
          {"planned", stored.runs().size()},
          {"partial", source.summary.runs < stored.runs().size() && !source.summary.stopped},
          {"stopped", source.summary.stopped},
          {"rows", source.has_rows()},
          {"shard", shard ? Json(fmt::format("{}/{}", shard->index, shard->of)) : Json(nullptr)},
          {"design", design_names[static_cast<std::size_t>(campaign.sampling.design)]},
          {"confidence", source.summary.confidence},
          {"looks", source.summary.interim.count()},
          {"replicates", source.replication.replicates},
          {"made_by", made_by(source)},
          {"judged_by", judged_by(source)}};
}

Json statuses_json(const Summary& summary) {
  Json json = Json::array();
  for (const StatusShare& share : summary.statuses) {
    json.push_back({{"status", to_string(share.status)},
                    {"count", share.count},
                    {"rate", page_share(share.rate)}});
    add_share_bounds(json.back(), share.bounds);
    if (std::string why = why_no_bound(summary, share); !why.empty())
      json.back()["note"] = std::move(why);
  }
  return json;
}

Json reasons_json(const Summary& summary) {
  constexpr std::size_t most_reasons_shown = 50;
  Json json = Json::array();
  for (const auto& [status, reason, count] : summary.reasons)
    if (json.size() < most_reasons_shown)
      json.push_back({{"status", to_string(status)}, {"reason", reason}, {"count", count}});
  return json;
}

Json stalled_at_json(const Summary& summary) {
  Json json = Json::array();
  for (const StoppedHinge& each : summary.stalled_at)
    json.push_back({{"hinge", each.hinge},
                    {"count", each.runs},
                    {"median", page_number(each.median)},
                    {"least", page_number(each.least)},
                    {"largest", page_number(each.largest)}});
  return json;
}

/// The gaps of an order of these hinges; empty without rows.
Json gaps_json(const PageSource& source, const std::vector<std::string>& hinges,
               const std::string& order) {
  Json json = Json::array();
  if (!source.has_rows()) return json;
  for (const LatchGap& gap : latch_gaps(source.results, hinges, order))
    json.push_back({{"before", gap.before},
                    {"after", gap.after},
                    {"least", page_number(gap.least, 4)},
                    {"median", page_number(gap.median, 4)}});
  return json;
}

/// An order of all hinges has gaps if the scene is one wing; of several, the orders of each wing have them.
Json orders_json(const PageSource& source, bool several_wings) {
  std::vector<std::string> hinges;
  for (const Hinge& hinge : source.stored.campaign.scene.hinges) hinges.push_back(hinge.name);
  Json json = Json::array();
  for (const auto& [name, count] : source.orders->groups())
    json.push_back({{"order", name},
                    {"count", count},
                    {"gaps", several_wings ? Json::array() : gaps_json(source, hinges, name)}});
  return json;
}

/// At most six orders of each wing.
Json wing_orders_json(const PageSource& source) {
  Json json = Json::array();
  const OrderCounts counts =
      source.has_rows() ? order_counts(source.results) : source.streaming->latch_orders();
  for (const WingOrders& wing : wing_orders(counts, source.stored.campaign.scene)) {
    Json orders = Json::array();
    for (const auto& [name, count] : wing.orders)
      if (orders.size() < OrderSplit::most_orders)
        orders.push_back(
            {{"order", name}, {"count", count}, {"gaps", gaps_json(source, wing.hinges, name)}});
    json.push_back({{"wing", wing.name},
                    {"hinges", wing.hinges},
                    {"orders", std::move(orders)},
                    {"order_kinds", wing.orders.size()},
                    {"without_latch", wing.without}});
  }
  return json;
}

Json run_json(const JudgedRun& each, int digits) {
  return {{"run", each.run}, {"value", page_number(each.value, digits)}};
}

/// The digits of a requirement's values: those of its output.
int requirement_digits(const PageSource& source, const Requirement& requirement) {
  const auto output =
      std::ranges::find(source.summary.outputs, requirement.output, &OutputSummary::name);
  return output == source.summary.outputs.end() ? page_digits : digits_of(output->moments);
}

/// The page's keys about the runs that break a requirement.
Json broken_json(const Verdict& verdict, const PageSource& source) {
  constexpr std::size_t most_broken_shown = 5;
  const BrokenRuns broken = broken_runs_of(source, verdict, most_broken_shown);
  const int digits = requirement_digits(source, verdict.requirement);
  Json json{{"broken", verdict.failures()},
            {"not_deployed", broken.not_deployed},
            {"without_value", broken.without_value},
            {"cut", broken.cut},
            {"beyond", broken.beyond},
            {"worst", broken.worst ? run_json(*broken.worst, digits) : Json(nullptr)},
            {"beyond_runs", Json::array()},
            {"not_deployed_runs", Json::array()}};
  for (const JudgedRun& each : broken.beyond_runs)
    json["beyond_runs"].push_back(run_json(each, digits));
  for (const auto& [run, latched] : broken.not_deployed_runs)
    json["not_deployed_runs"].push_back({{"run", run}, {"latched", latched}});
  return json;
}

constexpr std::array verdict_words{"passed", "failed", "open"}; // in the order of Decision

/// What the requirements show together.
Json together_json(const Summary& summary) {
  Json groups = Json::array();
  for (const GroupVerdict& group : judge_groups(summary.requirements))
    groups.push_back({{"group", group.name},
                      {"confidence", group.confidence},
                      {"requirements", group.members},
                      {"passed", group.passed},
                      {"verdict", verdict_words[static_cast<std::size_t>(group.decision)]}});
  return {{"groups", std::move(groups)}, {"confidence", joint_confidence(summary.requirements)}};
}

/// A requirement without its verdict.
Json asked_json(const Requirement& requirement) {
  const bool limited = requirement.max || requirement.min;
  return {{"text", to_string(requirement)},
          {"name", requirement.name},
          {"output", requirement.output},
          {"unit", parse_output_name(requirement.output).unit},
          {"kind", !limited          ? "status"
                   : requirement.max ? "<="
                                     : ">="},
          {"limit", limited ? Json(*(requirement.max ? requirement.max : requirement.min))
                            : Json(nullptr)}, // in full: the page shows it as it was written
          {"upper", !limited || requirement.max},
          {"abs", requirement.absolute},
          {"static_margin", requirement.static_margin.has_value()},
          {"group", requirement.group},
          {"id", requirement.id},
          {"source", requirement.source},
          {"rationale", requirement.rationale},
          {"probability", requirement.probability},
          {"confidence", requirement.confidence}};
}

Json requirement_json(const Verdict& verdict, const PageSource& source) {
  Json json = asked_json(verdict.requirement);
  const int digits = requirement_digits(source, verdict.requirement);
  json.update({{"verdict", verdict_words[static_cast<std::size_t>(verdict.decision)]},
               {"disproved", verdict.disproved},
               {"observed", page_share(verdict.share)},
               {"guaranteed", page_share(verdict.guaranteed_share)},
               {"observed_value", page_number(verdict.observed, digits)},
               {"guaranteed_value", page_number(verdict.guaranteed, digits)},
               {"sure", page_number(verdict.confidence_alone)},
               {"margin", page_number(verdict.margin)},
               {"runs", verdict.runs},
               {"allowed", verdict.allowed ? Json(*verdict.allowed) : Json(nullptr)},
               {"evidence", evidence(verdict)}});
  json.update(broken_json(verdict, source));
  if (verdict.one_run) json["one_run"] = true;
  json["changes"] = changes_json(source, verdict);
  return json;
}

/// The summary's warnings, and one for outputs beyond the page's limit.
std::vector<std::string> all_warnings(const PageSource& source, const PageDetail& detail) {
  std::vector<std::string> lines = warnings(source.summary);
  if (const auto gaps = source.has_rows()
                            ? gaps_text(source.stored, source.results, source.summary.stopped)
                            : std::nullopt)
    lines.insert(lines.begin(), *gaps);
  // as `run` prints them; another tool's campaign was not run
  if (!source.stored.foreign)
    for (const InputWarning& warning : check_campaign(source.before_case, ""))
      lines.push_back("input: " + to_string(warning));
  if (source.stored.own_requirements)
    lines.push_back("the requirements are those that `wingspread analyze` was given, not the "
                    "campaign's");
  if (const std::size_t all = source.results.outputs.size(); all > detail.outputs)
    lines.push_back(
        fmt::format("the page shows {} of {} outputs, first those with a requirement; {} has all",
                    detail.outputs, all, (source.stored.folder / summary_file).string()));
  return lines;
}

/// Moves the differences between a recorded row and its run made again to the warnings.
void add_differences(Json& motion, Json& lines) {
  for (const Json& difference : motion.value("differs", Json::array()))
    lines.push_back(difference.get<std::string>() +
                    ": was the row edited? The statistics are those of the recorded rows");
  motion.erase("differs");
}

/// Hinges whose peak moment in the nominal run is mostly the jump of their latch's damping.
Json latch_jumps_json(const Summary& summary) {
  Json json = Json::array();
  for (const LatchJump& jump : summary.latch_jumps)
    json.push_back({{"hinge", jump.hinge},
                    {"moment", page_number(jump.moment)},
                    {"peak", page_number(jump.peak)}});
  return json;
}

Json requirements_json(const PageSource& source) {
  Json json = Json::array();
  for (const Verdict& verdict : source.summary.requirements)
    json.push_back(requirement_json(verdict, source));
  return json;
}

} // namespace

Json set_json(const PageSource& source, const PageDetail& detail, int threads) {
  const Summary& summary = source.summary;
  Json json = identity_json(source);
  json["statuses"] = statuses_json(summary);
  json["reasons"] = reasons_json(summary);
  if (!summary.stalled_at.empty()) json["stalled_at"] = stalled_at_json(summary);
  Json wings = wing_orders_json(source);
  json["orders"] = orders_json(source, !wings.empty());
  json["order_kinds"] = source.orders->kinds();
  if (summary.more_order_kinds) json["more_order_kinds"] = true;
  json["without_latch"] = summary.without_latch;
  json["wing_orders"] = std::move(wings);
  json["warnings"] = all_warnings(source, detail);
  json["latch_jumps"] = latch_jumps_json(summary);
  json["accuracy"] = accuracy_json(summary);
  json["requirements"] = requirements_json(source);
  json["together"] = together_json(summary);
  json["unjudged"] = unjudged_json(source);
  json["outputs"] = outputs_json(source, detail, threads);
  json["correlations"] = correlations_json(source, detail);
  json["sensitivity"] = effects_json(source, detail);
  json["scatters"] = scatters_json(source, detail, threads);
  json["wing"] = wing_json(nominal_scene(source.stored.campaign));
  json["motions"] = motions_json(source, detail, threads);
  for (Json& motion : json["motions"]) add_differences(motion, json["warnings"]);
  json["envelopes"] = envelopes_json(source, detail, threads);
  json["static_margins"] = nullptr;
  json["margin"] = nullptr;
  json["rare"] = nullptr;
  json["inputs"] = inputs_json(source, detail);
  return json;
}

} // namespace wingspread
