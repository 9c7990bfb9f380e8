#include "montecarlo/engine/mpi/evaluator_of.hpp"

namespace wingspread {

// In a file of its own and in no unity build: the program that is built with MPI has another definition of it, and the
// linker takes this one from the library only where it has found none.
std::unique_ptr<Evaluator> evaluator_of(const ThreadPool& pool, const std::atomic<bool>& stop) {
  return std::make_unique<ThreadEvaluator>(pool, stop);
}

} // namespace wingspread
