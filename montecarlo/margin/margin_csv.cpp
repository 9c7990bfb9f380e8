#include "montecarlo/formats/csv.hpp"
#include "montecarlo/margin/margin_report.hpp"
#include "montecarlo/statistics/binomial_bounds.hpp"

#include <fmt/format.h>

#include <initializer_list>

namespace wingspread {
namespace {

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
                           Term{"delivered", &MotorizationTerms::delivered}};

void append(std::string& row, double value) {
  row += ',';
  append_csv_cell(row, value);
}

void append(std::string& row, std::string_view text) {
  row += ',';
  append_csv_cell(row, text);
}

void append_numbers(std::string& row, std::initializer_list<double> values) {
  for (const double value : values) append(row, value);
}

void append_optional(std::string& row, const std::optional<double>& value) {
  row += ',';
  if (value) append_csv_cell(row, *value);
}

void append_verdict(std::string& row, const Verdict& verdict) {
  const Requirement& requirement = verdict.requirement;
  append(row, to_string(requirement));
  append(row, requirement.output);
  append_optional(row, requirement.max ? requirement.max : requirement.min);
  append_numbers(row, {requirement.probability, requirement.confidence});
  append(row, to_string(verdict.decision));
  row += fmt::format(",{},", verdict.broken.size());
  if (verdict.allowed) row += fmt::format("{}", *verdict.allowed);
  append_numbers(row, {verdict.share, verdict.guaranteed_share});
  append_optional(row, verdict.observed);
  append_optional(row, verdict.guaranteed);
}

void append_case(std::string& csv, const std::string& before, const CaseLook& look,
                 double confidence) {
  long runs = 0;
  for (const long count : look.statuses) runs += count;
  const long deployed = look.statuses[static_cast<std::size_t>(Status::deployed)];
  const Interval bounds = clopper_pearson(deployed, runs, confidence);
  std::string row = before + fmt::format(",{}", runs);
  append_numbers(
      row, {static_cast<double>(deployed) / static_cast<double>(runs), bounds.lower, bounds.upper});
  for (const Verdict& verdict : look.verdicts) {
    std::string line = row;
    append_verdict(line, verdict);
    csv += line + '\n';
  }
}

std::string motorization_header(const Campaign& campaign) {
  std::string header = "scale,hinge,travel,angle";
  for (const Term& term : terms) header += fmt::format(",{}", term.name);
  for (const std::string_view kind : margin_kind_names) {
    header += fmt::format(",{}", kind);
    for (const double p : campaign.statistics.quantiles) header += fmt::format(",{}@{}", kind, p);
    header += fmt::format(",{0}_share_below_0,{0}_least,{0}_worst_run", kind);
  }
  return header + '\n';
}

void append_point(std::string& csv, const TravelPoint& point) {
  append_numbers(csv, {point.x, point.angle});
  for (const Term& term : terms) append(csv, point.nominal.*term.member);
  for (std::size_t kind = 0; kind < margin_kind_names.size(); ++kind) {
    const MarginSpread& spread = point.spread[kind];
    append(csv, point.margins[kind]);
    for (const double value : spread.quantiles) append(csv, value);
    append_numbers(csv, {spread.share_short, spread.least});
    csv += spread.worst_run < 0 ? "," : fmt::format(",{}", spread.worst_run);
  }
  csv += '\n';
}

} // namespace

std::string margin_csv(const Campaign& campaign, const MarginResult& result) {
  std::string csv =
      "search,scale,case,runs,deployed,deployed_lower,deployed_upper,requirement,"
      "output,limit,probability,confidence,verdict,broken,allowed,share,guaranteed_share,observed,"
      "guaranteed\n";
  for (const MarginSearch& search : result.searches)
    for (const auto& [scale, look] : search.seen)
      for (std::size_t which = 0; which < look.size(); ++which) {
        std::string before;
        append_csv_cell(before, search.name);
        append(before, scale);
        append(before, result.cases[which].name);
        append_case(csv, before, look[which], campaign.statistics.confidence);
      }
  return csv;
}

std::string motorization_csv(const MarginReport& report) {
  std::string csv = motorization_header(report.campaign);
  for (const auto& [scale, study] : report.motorization)
    for (const HingeMotorization& each : study.hinges)
      for (const TravelPoint& point : each.travel) {
        append_csv_cell(csv, scale);
        append(csv, report.campaign.scene.hinges[each.hinge].name);
        append_point(csv, point);
      }
  return csv;
}

} // namespace wingspread
