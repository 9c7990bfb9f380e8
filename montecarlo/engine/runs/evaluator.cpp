#include "montecarlo/engine/runs/evaluator.hpp"

#include "montecarlo/engine/runs/chunk_scheduler.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"

#include <algorithm>

namespace wingspread {

long ThreadEvaluator::make(const RunPlan& plan, RunRange range, const BatchSink& sink) {
  ThreadPool pool = pool_;
  pool.threads = threads_for(pool_.threads, static_cast<std::size_t>(std::max(0L, range.size())));
  RangeQueue queue(range, pool.threads, sink, stop_);
  occupancy_ += make_chunks(plan, pool, sink.wants_csv, queue);
  return queue.done();
}

} // namespace wingspread
