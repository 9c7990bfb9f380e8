/// The program that mpirun starts: on rank 0 it is the one of every day, on the others it makes runs for that.
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

int work(int argc, char** argv) {
  const std::unique_ptr<Transport> wire = mpi_transport();
  if (wire->rank() > 0) {
    const Interrupt interrupt;
    serve(*wire, measure_of_recipe, interrupt.flag());
    return 0;
  }
  const int code = command_line(argc, argv);
  dismiss(*wire);
  return code;
}

} // namespace

// In place of the library's.
std::unique_ptr<Evaluator> evaluator_of(const ThreadPool& crew, const std::atomic<bool>& stop) {
  std::unique_ptr<Transport> wire = mpi_transport();
  if (wire->size() == 1) return std::make_unique<ThreadEvaluator>(crew, stop);
  return std::make_unique<RankEvaluator>(std::move(wire), crew, stop);
}

} // namespace wingspread

int main(int argc, char** argv) {
  int provided = 0; // all calls are made by this thread
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  const int code = wingspread::work(argc, argv);
  MPI_Finalize();
  return code;
}
