#include "montecarlo/analyses/margin/motorization_report.hpp"

#include "montecarlo/engine/runs/run_plan.hpp"
#include "montecarlo/foundation/formats/csv.hpp"
#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <span>

namespace wingspread {
namespace {

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

std::string case_of(const ScaledMotorization& at) {
  return at.campaign.of_case.empty() ? "nominal" : at.campaign.of_case;
}

const Hinge& leader_of(const DriveMotorization& each, const Campaign& campaign) {
  return campaign.scene.hinges[each.drive.hinges.front()];
}

/// A drive's least margins over its travel, kind by kind.
Json drive_json(const Campaign& campaign, const RunPlan& plan, const DriveMotorization& each) {
  const Hinge& hinge = leader_of(each, campaign);
  Json json{{"hinge", name_of(each.drive, campaign.scene)}};
  for (std::size_t kind = 0; kind < margin_kind_names.size(); ++kind) {
    Json entry{{"nominal", json_number(each.worst[kind])},
               {"angle", hinge.stowed + (hinge.latched - hinge.stowed) * each.worst_at[kind]}};
    entry["draws"] = spread_json(each.worst_spread[kind], campaign.statistics.quantiles);
    entry["draws"]["worst_draw"] = draws_of_run(campaign, plan, each.worst_spread[kind].worst_run);
    json[std::string(margin_kind_names[kind])] = std::move(entry);
  }
  return json;
}

using Member = double MotorizationTerms::*;
struct Term {
  const char* name;
  Member member;
};
constexpr std::array terms{Term{"available", &MotorizationTerms::available},
                           Term{"inertia", &MotorizationTerms::inertia},
                           Term{"spring", &MotorizationTerms::spring},
                           Term{"motor", &MotorizationTerms::motor},
                           Term{"friction", &MotorizationTerms::friction},
                           Term{"hysteresis", &MotorizationTerms::hysteresis},
                           Term{"harness", &MotorizationTerms::harness},
                           Term{"adhesion", &MotorizationTerms::adhesion},
                           Term{"acceleration", &MotorizationTerms::acceleration},
                           Term{"delivered", &MotorizationTerms::delivered},
                           Term{"damping", &MotorizationTerms::damping}};

std::string motorization_header(const Campaign& campaign) {
  std::string header = "scale,case,hinge,travel,angle";
  for (const Term& term : terms) header += fmt::format(",{}", term.name);
  for (const std::string_view kind : margin_kind_names) {
    header += fmt::format(",{}", kind);
    for (const double p : campaign.statistics.quantiles) header += fmt::format(",{}@{}", kind, p);
    header += fmt::format(",{0}_share_below_0,{0}_least,{0}_worst_run", kind);
  }
  return header + '\n';
}

void append_point(std::string& csv, const TravelPoint& point) {
  append_csv_cells(csv, point.x, point.angle);
  for (const Term& term : terms) append_csv_cells(csv, point.nominal.*term.member);
  for (std::size_t kind = 0; kind < margin_kind_names.size(); ++kind) {
    const MarginSpread& spread = point.spread[kind];
    append_csv_cells(csv, point.margins[kind]);
    for (const double value : spread.quantiles) append_csv_cells(csv, value);
    append_csv_cells(csv, spread.share_short, spread.least);
    csv += spread.worst_run < 0 ? "," : fmt::format(",{}", spread.worst_run);
  }
  csv += '\n';
}

/// A margin: "+0.67"; "∞" where nothing resists.
std::string margin_text(double margin) {
  if (std::isnan(margin)) return "–";
  return std::isinf(margin) ? "∞" : fmt::format("{:+.2f}", margin);
}

/// A line for each hinge and kind: the least over the travel.
std::string motorization_lines(const ScaledMotorization& at) {
  const Campaign& campaign = at.campaign;
  std::string text = campaign.of_case.empty() ? "" : campaign.of_case + '\n';
  for (const DriveMotorization& each : at.study.drives)
    for (std::size_t kind = 0; kind < margin_kind_names.size(); ++kind) {
      const Hinge& hinge = leader_of(each, campaign);
      const MarginSpread& spread = each.worst_spread[kind];
      const double angle = hinge.stowed + (hinge.latched - hinge.stowed) * each.worst_at[kind];
      const std::string whose =
          kind == 0 ? fmt::format("  {:<8}{}", at.scale, name_of(each.drive, campaign.scene)) : "";
      text += fmt::format("{}{:<22}{:>9}{:>9.3f}{:>10}{:>10}{:>8}\n", in_column(whose, 26),
                          margin_kind_texts[kind], margin_text(each.worst[kind]), angle,
                          margin_text(spread.quantiles.empty() ? NAN : spread.quantiles.front()),
                          margin_text(spread.least), spread.worst_run);
    }
  return text;
}

} // namespace

Json motorization_json(const Campaign& campaign, const std::vector<ScaledMotorization>& scales) {
  Json json{{"standards",
             {{"ecss", ecss_standard},
              {"nasa", nasa_standard},
              {"gevs", gevs_standard},
              {"aiaa", aiaa_standard}}}};
  json["factors"] = write_motorization(campaign.motorization, campaign.scene);
  json["springs_per_hinge"] = campaign.motorization.springs_per_hinge;
  json["at"] = Json::array();
  for (const ScaledMotorization& at : scales) {
    const RunPlan plan(at.campaign);
    Json drives = Json::array();
    for (const DriveMotorization& each : at.study.drives)
      drives.push_back(drive_json(at.campaign, plan, each));
    json["at"].push_back({{"scale", at.scale},
                          {"case", case_of(at)},
                          {"draws", at.study.draws},
                          {"invalid", at.study.invalid},
                          {"least_over_travel", drives}});
  }
  return json;
}

std::string motorization_csv(const Campaign& campaign,
                             const std::vector<ScaledMotorization>& scales) {
  std::string csv = motorization_header(campaign);
  for (const ScaledMotorization& at : scales)
    for (const DriveMotorization& each : at.study.drives)
      for (const TravelPoint& point : each.travel) {
        append_csv_cell(csv, at.scale);
        append_csv_cells(csv, case_of(at), name_of(each.drive, campaign.scene));
        append_point(csv, point);
      }
  return csv;
}

std::string motorization_text(const Campaign& campaign,
                              const std::vector<ScaledMotorization>& scales) {
  const MotorizationSpec& spec = campaign.motorization;
  const auto& quantiles = campaign.statistics.quantiles;
  std::string text =
      fmt::format("\nSTATIC MOTORIZATION MARGINS, least over the travel; 0 or more is enough\n"
                  "{}: {} · {}: {}\n{}: {} · {}: {}\n",
                  ecss_standard, ecss_basis_names[static_cast<std::size_t>(spec.ecss_basis)],
                  nasa_standard, nasa_basis_names[static_cast<std::size_t>(spec.nasa_basis)],
                  gevs_standard, margin_phase_names[static_cast<std::size_t>(spec.gevs_phase)],
                  aiaa_standard, margin_phase_names[static_cast<std::size_t>(spec.aiaa_phase)]);
  const std::string quantile =
      quantiles.empty() ? "–" : fmt::format("{:g} %", 100 * quantiles.front());
  text += fmt::format("{:<10}{:<16}{:<22}{:>9}{:>9}{:>10}{:>10}{:>8}\n", "SCALE", "hinge", "by",
                      "nominal", "at rad", quantile, "least", "run");
  for (const ScaledMotorization& at : scales) text += motorization_lines(at);
  return text;
}

} // namespace wingspread
