#include "montecarlo/foundation/formats/number_text.hpp"
#include "montecarlo/foundation/platform/standard_error.hpp"
#include "montecarlo/interfaces/commands/cli.hpp"

#include <cstdlib>
#include <string_view>

namespace {

/// This program has no MPI. If mpirun starts it several times, each process makes all runs: the first warns of it.
void warn_of_mpirun() {
  const char *size = std::getenv("OMPI_COMM_WORLD_SIZE"),
             *rank = std::getenv("OMPI_COMM_WORLD_RANK");
  if (!size || !rank || std::string_view(rank) != "0") return;
  if (wingspread::parse_number<long>(size).value_or(1) > 1)
    wingspread::print_message(
        "warning: mpirun starts this program {} times, and each process makes "
        "all runs: a build with MPI shares them (cmake --preset mpi)\n",
        size);
}

} // namespace

int main(int argc, char** argv) {
  warn_of_mpirun();
  return wingspread::command_line(argc, argv);
}
