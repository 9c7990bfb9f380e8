#include "montecarlo/analyses/margin/margin_report.hpp"
#include "montecarlo/foundation/formats/csv.hpp"

namespace wingspread {
namespace {

void append_verdict(std::string& row, const Verdict& verdict) {
  const Requirement& requirement = verdict.requirement;
  append_csv_cells(row, to_string(requirement), requirement.output,
                   requirement.max ? requirement.max : requirement.min, requirement.probability,
                   requirement.confidence, to_string(verdict.decision), verdict.broken.size(),
                   verdict.allowed, verdict.share, verdict.guaranteed_share, verdict.observed,
                   verdict.guaranteed);
}

void append_case(std::string& csv, const std::string& before, const CaseResult& one,
                 double confidence) {
  const DeployedShare deployed = deployed_share(one, confidence);
  std::string row = before;
  append_csv_cells(row, deployed.runs, deployed.share, deployed.bounds.lower,
                   deployed.bounds.upper);
  for (const Verdict& verdict : one.verdicts) {
    std::string line = row;
    append_verdict(line, verdict);
    csv += line + '\n';
  }
}

} // namespace

std::string margin_csv(const Campaign& campaign, const MarginResult& result) {
  std::string csv =
      "search,scale,case,runs,deployed,deployed_lower,deployed_upper,requirement,"
      "output,limit,probability,confidence,verdict,broken,allowed,share,guaranteed_share,observed,"
      "guaranteed\n";
  for (const MarginSearch& search : result.searches)
    for (const auto& [scale, cases] : search.seen)
      for (std::size_t which = 0; which < cases.size(); ++which) {
        std::string before;
        append_csv_cell(before, search.name);
        append_csv_cells(before, scale, result.cases[which].name);
        append_case(csv, before, cases[which], campaign.statistics.confidence);
      }
  return csv;
}

} // namespace wingspread
