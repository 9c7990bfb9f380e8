#include "montecarlo/interfaces/commands/command_setup.hpp"

#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace wingspread {
namespace {

/// @throws CLI::ValidationError when this processor lacks it
InstructionSet instruction_set(const std::string& name, int lanes) {
  const std::vector<InstructionSet>& sets = instruction_sets();
  const auto fits = [&](InstructionSet set) {
    return (name.empty() || name == to_string(set)) && (lanes == 0 || lanes == lanes_of(set));
  };
  const auto found = std::find_if(sets.rbegin(), sets.rend(), fits);
  if (found != sets.rend()) return *found;
  std::vector<std::string> offered;
  for (const InstructionSet set : sets)
    offered.push_back(fmt::format("{} ({})", to_string(set), lanes_of(set)));
  const std::string asked =
      name.empty()
          ? fmt::format("--lanes {}", lanes)
          : fmt::format("--isa {}{}", name, lanes ? fmt::format(" --lanes {}", lanes) : "");
  throw CLI::ValidationError(asked,
                             fmt::format("this processor does not have that; it has (lanes): {}",
                                         fmt::join(offered, ", ")));
}

} // namespace

SpecError in_file(const SpecError& error, const std::filesystem::path& file) {
  std::vector<Problem> problems = error.problems();
  for (Problem& problem : problems)
    if (problem.file.empty() && problem.pointer.starts_with('/')) problem.file = file.string();
  return SpecError(std::move(problems));
}

void refuse_empty_arguments(CLI::App& command) {
  const auto refuse = [](const std::string& text) -> std::string {
    if (!text.empty()) return "";
    return "found an empty argument, expected a value (a shell variable that is not set?)";
  };
  for (CLI::Option* option : command.get_options())
    if (option->get_items_expected_max() > 0) option->check(refuse);
}

void add_machine_options(CLI::App& command, MachineOptions& options) {
  within(command.add_option("--threads", options.threads,
                            "Threads; default: OMP_NUM_THREADS, or all processors"),
         1, most_threads)
      ->type_name("N");
  one_of(command.add_option("--lanes", options.lanes,
                            "Runs that one thread makes at once: 1, 2, 4 or 8; default: the most"),
         {"1", "2", "4", "8"})
      ->type_name("L");
  one_of(command.add_option("--isa", options.isa,
                            "Instruction set: scalar, neon, avx2 or avx512; default: the widest"),
         {"scalar", "neon", "avx2", "avx512"})
      ->type_name("NAME");
}

ThreadPool pool_of(const MachineOptions& options) {
  return {options.threads, instruction_set(options.isa, options.lanes)};
}

} // namespace wingspread
