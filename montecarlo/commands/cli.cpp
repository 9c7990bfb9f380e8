#include "montecarlo/commands/cli.hpp"

#include "montecarlo/commands/commands.hpp"
#include "montecarlo/folder/version.hpp"
#include "montecarlo/formats/spec_error.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <exception>
#include <string>
#include <string_view>

namespace wingspread {
namespace {

constexpr const char* footer = R"(Example:
  wingspread check campaign.json
  wingspread run campaign.json --out results/first
  wingspread replay results/first --run 17

Exit codes: 0 done, requirements met; 1 done, a requirement is not shown to be met; 2 bad input,
nothing was done; 3 some runs failed numerically; 130 interrupted, what is done is kept (run again
with --resume).)";

/// Every line of the message, marked as an error.
int refuse(std::string_view message) {
  while (!message.empty()) {
    const std::size_t end = message.find('\n');
    fmt::print(stderr, "error: {}\n", message.substr(0, end));
    message = end == std::string_view::npos ? "" : message.substr(end + 1);
  }
  return exit_code::bad_input;
}

/// The command that was named, for "see wingspread run --help".
std::string command_named(const CLI::App& app) {
  std::string named = app.get_name();
  for (const CLI::App* command : app.get_subcommands()) named += ' ' + command->get_name();
  return named;
}

int carry_out(const Action& action) {
  try {
    return action();
  } catch (const std::exception& error) {
    return refuse(error.what());
  }
}

} // namespace

int command_line(int argc, const char* const* argv) {
  CLI::App app(
      "Wingspread: how far the deployment of a spacecraft's solar wing may stray from the "
      "drawing.\nA Monte Carlo campaign over what varies in it, one run at a time or many.",
      "wingspread");
  app.footer(footer);
  app.set_version_flag("--version", version_text());
  Action action;
  add_run(app, action);
  add_simulate(app, action);
  add_replay(app, action);
  add_check(app, action);
  add_sample(app, action);
  add_analyze(app, action);
  add_merge(app, action);
  add_size(app, action);
  add_sensitivity(app, action);
  add_rare(app, action);
  add_margin(app, action);
  add_methods(app, action);
  add_version(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) { // --help, --version
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    return refuse(fmt::format("{}\nsee {} --help", error.what(), command_named(app)));
  }
  if (!action) return refuse("no command is given\nsee wingspread --help");
  return carry_out(action);
}

} // namespace wingspread
