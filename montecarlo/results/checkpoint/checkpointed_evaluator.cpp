#include "montecarlo/results/checkpoint/checkpointed_evaluator.hpp"

namespace wingspread {

long CheckpointedEvaluator::make(const RunPlan& plan, RunRange range, const BatchSink& sink) {
  const long logged = log_.enter(plan, range, sink, stop_);
  if (logged == range.size() || stop_) return logged;
  const auto keep = [&](const Batch& batch) {
    log_.add(batch);
    sink.take(batch);
  };
  return logged + inner_.make(plan, {range.first + logged, range.last}, {keep, sink.wants_csv});
}

} // namespace wingspread
