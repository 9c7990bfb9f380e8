#include "montecarlo/runs/evaluator.hpp"

#include "montecarlo/machine/team.hpp"
#include "montecarlo/runs/chunk_team.hpp"

namespace wingspread {

long ThreadEvaluator::make(const RunPlan& plan, RunRange range, const BatchSink& sink) {
  RangeDesk desk(range, team_size(crew_.threads), sink, stop_);
  occupancy_ += make_chunks(plan, crew_, sink.wants_csv, desk);
  return desk.done();
}

} // namespace wingspread
