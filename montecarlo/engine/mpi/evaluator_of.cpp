#include "montecarlo/engine/mpi/evaluator_of.hpp"

namespace wingspread {

// A file of its own, outside unity builds: the MPI program defines this function too, and the linker takes this one
// from the library only if no other exists.
std::unique_ptr<Evaluator> evaluator_of(const ThreadPool& pool, const std::atomic<bool>& stop) {
  return std::make_unique<ThreadEvaluator>(pool, stop);
}

} // namespace wingspread
