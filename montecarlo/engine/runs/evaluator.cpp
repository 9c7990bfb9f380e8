#include "montecarlo/engine/runs/evaluator.hpp"

#include "montecarlo/engine/runs/chunk_scheduler.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"

namespace wingspread {

long ThreadEvaluator::make(const RunPlan& plan, RunRange range, const BatchSink& sink) {
  RangeQueue queue(range, thread_count(pool_.threads), sink, stop_);
  occupancy_ += make_chunks(plan, pool_, sink.wants_csv, queue);
  return queue.done();
}

} // namespace wingspread
