#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/interfaces/commands/commands.hpp"
#include "montecarlo/report/text/method_list.hpp"
#include "montecarlo/results/results_folder/version.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <memory>

namespace wingspread {
namespace {

int list_methods(bool json) {
  fmt::print("{}", json ? json_text(methods_json(methods())) : methods_text(methods()));
  return exit_code::done;
}

} // namespace

std::string version_text() { return fmt::format("wingspread {}", version()); }

void add_methods(CLI::App& app, Action& action) {
  const auto json = std::make_shared<bool>(false);
  CLI::App* command =
      app.add_subcommand("methods", "The integration methods, and what they can do");
  command->add_flag("--json", *json, "Print them as JSON");
  command->footer("Example:\n  wingspread methods");
  command->callback([json, &action] { action = [json] { return list_methods(*json); }; });
}

void add_version(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("version", "The program's version");
  command->footer("Example:\n  wingspread version");
  command->callback([&action] {
    action = [] {
      fmt::print("{}\n", version_text());
      return exit_code::done;
    };
  });
}

} // namespace wingspread
