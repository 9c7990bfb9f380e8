#include "montecarlo/engine/runs/evaluator.hpp"

#include "montecarlo/engine/runs/chunk_scheduler.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"

namespace wingspread {

long ThreadEvaluator::make(const RunPlan& plan, RunRange range, const BatchSink& sink) {
  RangeQueue desk(range, thread_count(pool_.threads), sink, stop_);
  occupancy_ += make_chunks(plan, pool_, sink.wants_csv, desk);
  return desk.done();
}

} // namespace wingspread
