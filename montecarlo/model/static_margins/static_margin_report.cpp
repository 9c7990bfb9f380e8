#include "montecarlo/model/static_margins/static_margin_report.hpp"

#include "montecarlo/foundation/formats/csv.hpp"
#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

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

std::string case_name(const CaseMargins& at) { return at.of_case.empty() ? "nominal" : at.of_case; }

/// One drive's least margins over its travel, by standard.
Json drive_json(const DriveMargins& drive, std::span<const double> probabilities) {
  Json json{{"hinge", drive.hinge}};
  for (std::size_t kind = 0; kind < margin_kind_names.size(); ++kind) {
    Json entry{{"nominal", json_number(drive.worst[kind])},
               {"angle", json_number(drive.worst_angle[kind])}};
    entry["draws"] = spread_json(drive.worst_spread[kind], probabilities);
    entry["draws"]["worst_draw"] = drive.worst_draw[kind];
    json[std::string(margin_kind_names[kind])] = std::move(entry);
  }
  return json;
}

struct Term {
  const char* name;
  double TorqueTerms::*member;
};
constexpr std::array terms{Term{"available", &TorqueTerms::available},
                           Term{"inertia", &TorqueTerms::inertia},
                           Term{"spring", &TorqueTerms::spring},
                           Term{"motor", &TorqueTerms::motor},
                           Term{"friction", &TorqueTerms::friction},
                           Term{"hysteresis", &TorqueTerms::hysteresis},
                           Term{"harness", &TorqueTerms::harness},
                           Term{"adhesion", &TorqueTerms::adhesion},
                           Term{"acceleration", &TorqueTerms::acceleration},
                           Term{"delivered", &TorqueTerms::delivered},
                           Term{"damping", &TorqueTerms::damping}};

std::string csv_header(const std::vector<double>& probabilities) {
  std::string header = "scale,case,hinge,travel,angle";
  for (const Term& term : terms) header += fmt::format(",{}", term.name);
  for (const std::string_view kind : margin_kind_names) {
    header += fmt::format(",{}", kind);
    for (const double p : probabilities) header += fmt::format(",{}@{}", kind, p);
    header += fmt::format(",{0}_share_below_0,{0}_least,{0}_worst_run", kind);
  }
  return header + '\n';
}

void append_csv_point(std::string& csv, const TravelPoint& point) {
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

/// "+0.67", "+3e+17"; "∞" where nothing resists; "–" of NaN.
std::string margin_text(double margin, int digits = 2) {
  constexpr double most = 1e5; // columns have seven to ten characters
  if (std::isnan(margin)) return "–";
  if (std::isinf(margin)) return "∞";
  return std::abs(margin) < most ? fmt::format("{:+.{}f}", margin, digits)
                                 : fmt::format("{:+.1e}", margin);
}

std::string table_lines(const CaseMargins& at) {
  std::string text;
  for (const DriveMargins& drive : at.study.drives)
    for (std::size_t kind = 0; kind < margin_kind_names.size(); ++kind) {
      const MarginSpread& spread = drive.worst_spread[kind];
      const std::string name =
          kind == 0 ? fmt::format("  {:<8}{}", at.scale, drive.hinge) : std::string();
      text += fmt::format(
          "{}{:<22}{:>9}{:>9}{:>10}{:>10}{:>8}\n", in_column(name, 26), margin_kind_texts[kind],
          margin_text(drive.worst[kind]),
          std::isnan(drive.worst[kind]) ? "–" : degrees_text(drive.worst_angle[kind]),
          margin_text(spread.quantiles.empty() ? undefined : spread.quantiles.front()),
          margin_text(spread.least), spread.worst_run < 0 ? "–" : std::to_string(spread.worst_run));
    }
  return text;
}

/// Digits of a margin on the page.
constexpr int curve_digits = 5;

/// The quantile at the lowest probability; NaN without quantiles.
double lowest(const MarginSpread& spread, const std::vector<double>& probabilities) {
  if (spread.quantiles.empty()) return undefined;
  const auto least = std::ranges::min_element(probabilities) - probabilities.begin();
  return spread.quantiles[static_cast<std::size_t>(least)];
}

Json curve_json(const DriveMargins& drive, std::size_t kind,
                const std::vector<double>& probabilities) {
  Json json{{"hinge", drive.hinge},
            {"angle", Json::array()},
            {"margin", Json::array()},
            {"margin_lower", Json::array()},
            {"required", 0}};
  for (const TravelPoint& point : drive.travel) {
    json["angle"].push_back(json_number(point.angle, 7));
    json["margin"].push_back(json_number(point.margins[kind], curve_digits));
    json["margin_lower"].push_back(
        json_number(lowest(point.spread[kind], probabilities), curve_digits));
  }
  json["least"] = json_number(drive.worst[kind], curve_digits);
  json["lower"] = json_number(lowest(drive.worst_spread[kind], probabilities), curve_digits);
  return json;
}

} // namespace

Json static_margins_json(const StaticMarginReport& report) {
  Json json{{"standards",
             {{"ecss", ecss_standard},
              {"nasa", nasa_standard},
              {"gevs", gevs_standard},
              {"aiaa", aiaa_standard}}}};
  json["factors"] = write_static_margins(report.spec, report.scene);
  json["springs_per_hinge"] = report.spec.springs_per_hinge;
  json["at"] = Json::array();
  for (const CaseMargins& at : report.cases) {
    Json drives = Json::array();
    for (const DriveMargins& drive : at.study.drives)
      drives.push_back(drive_json(drive, report.probabilities));
    json["at"].push_back({{"scale", at.scale},
                          {"case", case_name(at)},
                          {"draws", at.study.draws},
                          {"invalid", at.study.invalid},
                          {"least_over_travel", drives}});
  }
  return json;
}

std::string static_margins_csv(const StaticMarginReport& report) {
  std::string csv = csv_header(report.probabilities);
  for (const CaseMargins& at : report.cases)
    for (const DriveMargins& drive : at.study.drives)
      for (const TravelPoint& point : drive.travel) {
        append_csv_cell(csv, at.scale);
        append_csv_cells(csv, case_name(at), drive.hinge);
        append_csv_point(csv, point);
      }
  return csv;
}

std::string static_margins_text(const StaticMarginReport& report) {
  const StaticMarginSpec& spec = report.spec;
  std::string text =
      fmt::format("\nSTATIC MARGINS (motorization), least over the travel; 0 or more is enough\n"
                  "{}: {} · {}: {}\n{}: {} · {}: {}\n",
                  ecss_standard, ecss_basis_names[static_cast<std::size_t>(spec.ecss_basis)],
                  nasa_standard, nasa_basis_names[static_cast<std::size_t>(spec.nasa_basis)],
                  gevs_standard, margin_phase_names[static_cast<std::size_t>(spec.gevs_phase)],
                  aiaa_standard, margin_phase_names[static_cast<std::size_t>(spec.aiaa_phase)]);
  const std::string quantile = report.probabilities.empty()
                                   ? "–"
                                   : fmt::format("{:g} %", 100 * report.probabilities.front());
  text += fmt::format("{:<10}{:<16}{:<22}{:>9}{:>9}{:>10}{:>10}{:>8}\n", "SCALE", "hinge",
                      "standard", "nominal", "at deg", quantile, "least", "run");
  for (const CaseMargins& at : report.cases) {
    if (!at.of_case.empty()) text += at.of_case + '\n';
    text += table_lines(at);
  }
  return text;
}

std::string nominal_margins_text(const std::vector<std::pair<std::string, Scene>>& wings,
                                 const StaticMarginSpec& spec) {
  std::vector<std::pair<std::string, Margins>> lines;
  std::size_t longest = 0;
  for (const auto& [of_case, scene] : wings)
    for (const HingeDrive& drive : drives_of(scene)) {
      Margins margins;
      margins.fill(undefined);
      if (unphysical(scene).empty()) margins = least_margins(scene, drive, spec);
      for (std::size_t kind = 0; kind < margins.size(); ++kind)
        if (!applies(static_cast<MarginKind>(kind), scene, drive)) margins[kind] = undefined;
      const std::string suffix = of_case.empty() ? "" : " (" + of_case + ")";
      lines.emplace_back(name_of(drive, scene) + suffix, margins);
      longest = std::max(longest, lines.back().first.size());
    }
  if (lines.empty()) return "";
  std::string text = "static margins, least over the travel, dispersions at their medians; 0 or "
                     "more is enough\n" +
                     std::string(longest + 2, ' ');
  for (const std::string_view kind : margin_kind_texts) text += fmt::format("  {:>7}", kind);
  for (const auto& [name, margins] : lines) {
    text += fmt::format("\n  {:<{}}", name, longest);
    for (std::size_t kind = 0; kind < margins.size(); ++kind)
      text += fmt::format("  {:>{}}", margin_text(margins[kind], 3),
                          std::max<std::size_t>(7, margin_kind_texts[kind].size()));
  }
  const bool is_pushed = std::ranges::any_of(wings, [](const auto& wing) {
    const Scene& scene = wing.second;
    return !scene.environment.gravity.isZero(0) || scene.base.motion == BaseMotion::prescribed;
  });
  if (is_pushed) text += "\n  without gravity and the base's accelerations";
  return text + '\n';
}

Json static_margin_curves(const StaticMarginStudy& study, MarginKind kind,
                          const std::vector<double>& probabilities) {
  if (study.drives.empty()) return nullptr;
  const auto index = static_cast<std::size_t>(kind);
  Json json{
      {"kind", margin_kind_texts[index]},
      {"draws", study.draws},
      {"lower_p", probabilities.empty() ? Json(nullptr) : Json(std::ranges::min(probabilities))},
      {"hinges", Json::array()}};
  for (const DriveMargins& drive : study.drives)
    if (!std::isnan(drive.worst[index]))
      json["hinges"].push_back(curve_json(drive, index, probabilities));
  return json["hinges"].empty() ? Json(nullptr) : json;
}

} // namespace wingspread
