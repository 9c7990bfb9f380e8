#include "montecarlo/results/checkpoint/analysis_id.hpp"

#include "montecarlo/foundation/formats/csv.hpp"

#include <fmt/format.h>

namespace wingspread {
namespace {

void append_draws(std::string& text, const RunPlan& plan, long run) {
  std::vector<double> draws(plan.names().draws.size());
  plan.draw(run, draws);
  for (const double draw : draws) append_csv_cells(text, draw);
  text += ';';
}

} // namespace

std::string analysis_id(const RunPlan& plan, RunRange range) {
  std::string kept;
  for (const std::string& output : plan.names().outputs) kept += output + ';';
  if (plan.names().peaks_final) kept += peaks_final_column;
  for (const long run : {range.first, range.last - 1})
    if (range.size() > 0) append_draws(kept, plan, run);
  return fmt::format("campaign {} · runs {} to {} · {:016x}",
                     campaign_hash(plan.campaign().resolved), range.first, range.last - 1,
                     stream_name(kept).hash);
}

} // namespace wingspread
