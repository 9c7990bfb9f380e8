#include "montecarlo/engine/runs/evaluator.hpp"

#include "montecarlo/engine/runs/chunk_team.hpp"
#include "montecarlo/foundation/platform/team.hpp"

namespace wingspread {

long ThreadEvaluator::make(const RunPlan& plan, RunRange range, const BatchSink& sink) {
  RangeDesk desk(range, team_size(crew_.threads), sink, stop_);
  occupancy_ += make_chunks(plan, crew_, sink.wants_csv, desk);
  return desk.done();
}

} // namespace wingspread
