#include "montecarlo/interfaces/commands/cli.hpp"

#include "montecarlo/foundation/formats/machine_error.hpp"
#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/interfaces/commands/commands.hpp"
#include "montecarlo/results/results_folder/version.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <fcntl.h>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <unistd.h>

namespace wingspread {
namespace {

constexpr const char* footer = R"(Example:
  wingspread check campaign.json
  wingspread run campaign.json --out results/first
  wingspread replay results/first --run 17

Exit codes: 0 done, requirements met; 1 done, a requirement is not shown to be met; 2 bad input,
nothing was done; 3 some runs failed numerically; 4 the machine refused (no room, memory or
permission), what is done is kept; 130 interrupted, what is done is kept (run again with --resume).)";

/// Every line of the message, marked as an error. @return the code
int refuse(std::string_view message, int code = exit_code::bad_input) {
  const std::string shown = printable(message);
  message = shown;
  while (!message.empty()) {
    const std::size_t end = message.find('\n');
    fmt::print(stderr, "error: {}\n", message.substr(0, end));
    message = end == std::string_view::npos ? "" : message.substr(end + 1);
  }
  return code;
}

/// Where the program was started without one of its three standard files, a file of results could get its number,
/// and be printed into. What is opened in its place can be neither read nor written.
void hold_standard_files() {
  while (true) {
    const int file = open("/dev/null", O_PATH | O_CLOEXEC);
    if (file > STDERR_FILENO) close(file);
    if (file < 0 || file > STDERR_FILENO) return;
  }
}

/// The exit status, unless what was printed did not get out.
int after_output(int code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  const std::string why = std::generic_category().message(errno);
  return refuse("standard output: found " + why + ", expected room for what is printed",
                exit_code::machine_refused);
}

/// The command that was named, for "see wingspread run --help".
std::string command_named(const CLI::App& app) {
  std::string named = app.get_name();
  for (const CLI::App* command : app.get_subcommands()) named += ' ' + command->get_name();
  return named;
}

} // namespace

int carry_out(const Action& action) {
  try {
    return action();
  } catch (const MachineError& error) {
    return refuse(error.what(), exit_code::machine_refused);
  } catch (const std::system_error& error) { // of standard output, of threads
    return refuse(error.what(), exit_code::machine_refused);
  } catch (const std::bad_alloc&) {
    return refuse("found no memory left, expected more of it", exit_code::machine_refused);
  } catch (const std::exception& error) {
    return refuse(error.what());
  }
}

std::span<const Command> all_commands() {
  static constexpr Command all[] = {{"run", add_run},
                                    {"simulate", add_simulate},
                                    {"replay", add_replay},
                                    {"check", add_check},
                                    {"sample", add_sample},
                                    {"analyze", add_analyze},
                                    {"merge", add_merge},
                                    {"size", add_size},
                                    {"sensitivity", add_sensitivity},
                                    {"rare", add_rare},
                                    {"margin", add_margin},
                                    {"report", add_report},
                                    {"export", add_export},
                                    {"methods", add_methods},
                                    {"schema", add_schema},
                                    {"version", add_version},
                                    {"completion", add_completion},
                                    {"man", add_man}};
  return all;
}

Understood understand(int argc, const char* const* argv, std::span<const Command> commands) {
  CLI::App app(
      "Wingspread: how far the deployment of a spacecraft's solar wing may stray from the "
      "drawing.\nA Monte Carlo campaign over what varies in it, one run at a time or many.",
      "wingspread");
  app.footer(footer);
  app.set_version_flag("--version", version_text());
  Action action;
  for (const Command& command : commands) command.add(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) { // --help, --version
    return {{}, app.exit(asked)};
  } catch (const CLI::ParseError& error) {
    return {{}, refuse(fmt::format("{}\nsee {} --help", error.what(), command_named(app)))};
  }
  if (!action) return {{}, refuse("no command is given\nsee wingspread --help")};
  return {action};
}

int command_line(int argc, const char* const* argv) {
  hold_standard_files();
  // a file that may grow no more (ulimit -f, which some clusters set) is then an error like a full disk, and no silent end
  (void)std::signal(SIGXFSZ, SIG_IGN);
  const Understood understood = understand(argc, argv);
  return after_output(understood.action ? carry_out(understood.action) : understood.code);
}

} // namespace wingspread
