#include "montecarlo/formats/csv.hpp"
#include "montecarlo/margin/margin_report.hpp"
#include "montecarlo/statistics/binomial_bounds.hpp"

#include <fmt/format.h>

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

void append_verdict(std::string& row, const Verdict& verdict) {
  const Requirement& requirement = verdict.requirement;
  append_csv_cells(row, to_string(requirement), requirement.output,
                   requirement.max ? requirement.max : requirement.min, requirement.probability,
                   requirement.confidence, to_string(verdict.decision), verdict.broken.size(),
                   verdict.allowed, verdict.share, verdict.guaranteed_share, verdict.observed,
                   verdict.guaranteed);
}

void append_case(std::string& csv, const std::string& before, const CaseLook& look,
                 double confidence) {
  long runs = 0;
  for (const long count : look.statuses) runs += count;
  const long deployed = look.statuses[static_cast<std::size_t>(Status::deployed)];
  const Interval bounds = clopper_pearson(deployed, runs, confidence);
  std::string row = before;
  append_csv_cells(row, runs, static_cast<double>(deployed) / static_cast<double>(runs),
                   bounds.lower, bounds.upper);
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
        append_csv_cells(before, scale, result.cases[which].name);
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
        append_csv_cells(csv, report.campaign.scene.hinges[each.hinge].name);
        append_point(csv, point);
      }
  return csv;
}

} // namespace wingspread
