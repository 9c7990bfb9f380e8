/// The program for mpirun: rank 0 runs the command line, the other ranks make runs for rank 0.
#include "montecarlo/analyses/rare/limit_state.hpp"
#include "montecarlo/engine/mpi/evaluator_of.hpp"
#include "montecarlo/engine/mpi/mpi_transport.hpp"
#include "montecarlo/engine/mpi/rank_evaluator.hpp"
#include "montecarlo/engine/mpi/serve.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/interfaces/commands/cli.hpp"

#include <mpi.h>

namespace wingspread {
namespace {

int run_rank(int argc, char** argv) {
  const std::unique_ptr<Transport> transport = mpi_transport();
  if (transport->rank() > 0) {
    const Interrupt interrupt;
    serve(*transport, measure_of_recipe, interrupt.flag());
    return 0;
  }
  const int code = command_line(argc, argv);
  dismiss(*transport);
  return code;
}

} // namespace

// Replaces the library's evaluator_of.
std::unique_ptr<Evaluator> evaluator_of(const ThreadPool& pool, const std::atomic<bool>& stop) {
  std::unique_ptr<Transport> transport = mpi_transport();
  if (transport->size() == 1) return std::make_unique<ThreadEvaluator>(pool, stop);
  return std::make_unique<RankEvaluator>(std::move(transport), pool, stop);
}

} // namespace wingspread

int main(int argc, char** argv) {
  int provided = 0; // not checked: only this thread calls MPI
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  const int code = wingspread::run_rank(argc, argv);
  MPI_Finalize();
  return code;
}
