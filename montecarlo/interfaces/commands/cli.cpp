#include "montecarlo/interfaces/commands/cli.hpp"

#include "montecarlo/foundation/formats/machine_error.hpp"
#include "montecarlo/foundation/formats/nearest.hpp"
#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/foundation/platform/standard_error.hpp"
#include "montecarlo/interfaces/commands/commands.hpp"
#include "montecarlo/results/results_folder/version.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <fcntl.h>
#include <filesystem>
#include <new>
#include <regex>
#include <string>
#include <string_view>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace wingspread {
namespace {

constexpr const char* description =
    "Wingspread: Monte Carlo simulation of the deployment of spacecraft solar wings.\n"
    "Shows how far a deployment may differ from the drawing, and whether it meets its "
    "requirements.";

constexpr const char* footer = R"(Example:
  wingspread new --panels 4 --yoke --out wing
  wingspread check wing/campaign.json
  wingspread run wing/campaign.json --out results/first
  wingspread report results/first

Exit codes: 0 done, requirements met; 1 done, a requirement is not shown to be met; 2 bad input,
nothing was done; 3 some runs failed numerically; 4 the machine refused (no disk space, memory or
permission), finished runs are kept; 130 interrupted, finished runs are kept (continue with
--resume).)";

/// Prints every line of the message as an error. @return the code
int print_error(std::string_view message, int code = exit_code::bad_input) {
  const std::string shown = printable(message);
  message = shown;
  while (!message.empty()) {
    const std::size_t end = message.find('\n');
    print_message("error: {}\n", message.substr(0, end));
    message = end == std::string_view::npos ? "" : message.substr(end + 1);
  }
  return code;
}

/// Opens missing standard files with a placeholder that can be neither read nor written. Without it a results file
/// could get the descriptor of standard output, and printed text would end up in it.
void open_standard_files() {
  while (true) {
    const int file = open("/dev/null", O_PATH | O_CLOEXEC);
    if (file > STDERR_FILENO) close(file);
    if (file < 0 || file > STDERR_FILENO) return;
  }
}

/// Flushes standard output. @return the code, or machine_refused when that fails
int flush_output(int code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  const std::string why = std::generic_category().message(errno);
  return print_error("standard output: found " + why + ", expected room for the output",
                     exit_code::machine_refused);
}

/// The full name of a command, e.g. "wingspread run".
std::string name_of_command(const CLI::App& app) {
  std::string named = app.get_name();
  for (const CLI::App* command : app.get_subcommands()) named += ' ' + command->get_name();
  return named;
}

/// The options of a command, as a user writes them.
std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> words;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) words.push_back("--" + name);
  return words;
}

/// " (did you mean "--probability"?)", also for "--prob"; empty if no option is similar.
std::string meant_option(const std::string& option, const std::vector<std::string>& known) {
  constexpr std::size_t shortest = 4; // two dashes and two letters
  const auto longer = std::ranges::find_if(
      known, [&](const std::string& each) { return each.starts_with(option); });
  return did_you_mean(option.size() >= shortest && longer != known.end() ? *longer : option, known);
}

std::vector<std::string> names_of(std::span<const Command> commands) {
  std::vector<std::string> names;
  for (const Command& command : commands) names.emplace_back(command.name);
  return names;
}

/// " (write --until before each of its values)", for the first given option that takes one value at a time; else empty.
std::string repeated_option(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    if (option->count() > 0 && option->get_expected_max() > 1 && !option->get_allow_extra_args())
      return fmt::format(" (write {} before each of its values)", option->get_name());
  return "";
}

/// One line for each argument that no command or option takes: the unknown options, else the first word.
std::string unknown_text(const CLI::App& app, std::span<const Command> commands) {
  const std::vector<std::string> left = app.remaining(true);
  const auto given = app.get_subcommands();
  const std::vector<std::string> known = options_of(given.empty() ? app : *given.front());
  std::string text;
  for (const std::string& argument : left)
    if (argument.starts_with('-') && argument.size() > 1) {
      const std::string option = argument.substr(0, argument.find('='));
      text += fmt::format("found the unknown option \"{}\", expected an option of {}{}\n", option,
                          name_of_command(app), meant_option(option, known));
    }
  if (!text.empty() || left.empty()) return text;
  const bool is_command = given.empty();
  const std::string repeated = is_command ? "" : repeated_option(*given.front());
  return fmt::format("found {} \"{}\", expected {}{}\n",
                     is_command ? "the unknown command" : "the argument", left.front(),
                     is_command ? "a command of wingspread" : "no further argument",
                     is_command ? did_you_mean(left.front(), names_of(commands)) : repeated);
}

/// The error of an option's value in this program's form; other errors in the library's words.
std::string error_text(const CLI::ParseError& error) {
  const std::string words = error.what();
  std::smatch found;
  if (std::regex_match(words, found, std::regex("Could not convert: (.+?) = (.*)")))
    return fmt::format("{}: found \"{}\", expected {}", found.str(1), found.str(2),
                       found.str(2).find(',') == std::string::npos ? "a number" : "numbers");
  if (std::regex_match(words, found, std::regex("(.+): 1 required (.+) missing"))) {
    const std::string type = found.str(2);
    return fmt::format("{}: found no value, expected {}", found.str(1),
                       type == "TEXT"                     ? "a value"
                       : type == "FLOAT" || type == "INT" ? "a number"
                                                          : type);
  }
  if (std::regex_match(words, found, std::regex("(.+): At least (.+) required but received (.+)")))
    return fmt::format("{}: found {}, expected {} values", found.str(1), found.str(3),
                       found.str(2));
  return words;
}

/// A line for each problem of the command line. A misspelt option comes before a missing one: they may be the same.
std::string text_of(const CLI::ParseError& error, const CLI::App& app,
                    std::span<const Command> commands) {
  const std::string unknown = unknown_text(app, commands);
  const bool is_all = !unknown.empty() && dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  return is_all ? unknown : unknown + error_text(error) + '\n';
}

} // namespace

int run_action(const Action& action) {
  try {
    return action();
  } catch (const MachineError& error) {
    return print_error(error.what(), exit_code::machine_refused);
  } catch (const std::filesystem::filesystem_error& error) { // a path without permission
    return run_action([&]() -> int {
      refuse_path(error.path1(), error.code().value(), "a path that can be opened");
    });
  } catch (const std::system_error& error) { // from standard output or threads
    return print_error(error.what(), exit_code::machine_refused);
  } catch (const std::bad_alloc&) {
    return print_error("found no memory left, expected more memory", exit_code::machine_refused);
  } catch (const std::exception& error) {
    return print_error(error.what());
  }
}

std::span<const Command> all_commands() {
  static constexpr Command all[] = {{"new", add_new},
                                    {"run", add_run},
                                    {"simulate", add_simulate},
                                    {"replay", add_replay},
                                    {"check", add_check},
                                    {"modes", add_modes},
                                    {"sample", add_sample},
                                    {"analyze", add_analyze},
                                    {"merge", add_merge},
                                    {"size", add_size},
                                    {"sensitivity", add_sensitivity},
                                    {"rare", add_rare},
                                    {"margin", add_margin},
                                    {"fit", add_fit},
                                    {"report", add_report},
                                    {"export", add_export},
                                    {"methods", add_methods},
                                    {"schema", add_schema},
                                    {"version", add_version}};
  return all;
}

ParsedArguments parse_arguments(int argc, const char* const* argv,
                                std::span<const Command> commands) {
  CLI::App app(description, "wingspread");
  app.footer(footer);
  app.set_version_flag("--version", version_text());
  app.require_subcommand(0, 1); // after the first, a folder may have a command's name
  Action action;
  for (const Command& command : commands) command.add(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) { // --help, --version
    return {{}, app.exit(asked)};
  } catch (const CLI::ParseError& error) {
    return {{},
            print_error(fmt::format("{}see {} --help", text_of(error, app, commands),
                                    name_of_command(app)))};
  }
  if (!action) return {{}, print_error("no command is given\nsee wingspread --help")};
  return {action};
}

int command_line(int argc, const char* const* argv) {
  open_standard_files();
  // Some clusters limit the size of files (ulimit -f). A file that is too long then raises this signal, which ends the
  // program without a message. If the signal is ignored, the write fails as on a full disk.
  (void)std::signal(SIGXFSZ, SIG_IGN);
  const ParsedArguments parsed = parse_arguments(argc, argv);
  return flush_output(parsed.action ? run_action(parsed.action) : parsed.code);
}

} // namespace wingspread
