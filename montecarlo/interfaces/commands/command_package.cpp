#include "montecarlo/interfaces/commands/commands.hpp"
#include "montecarlo/interfaces/package/completion.hpp"
#include "montecarlo/interfaces/package/man_page.hpp"
#include "montecarlo/model/schema/schema.hpp"
#include "montecarlo/results/results_folder/version.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>

namespace wingspread {
namespace {

Action printing(std::string text) {
  return [text = std::move(text)] {
    fmt::print("{}", text);
    return exit_code::done;
  };
}

/// The page that is named; of an unknown name an error.
std::string page_of(const std::vector<CommandEntry>& table, const std::string& name) {
  const auto found =
      name.empty() ? table.begin() : std::ranges::find(table, name, &CommandEntry::name);
  if (found == table.end()) throw CLI::ValidationError("no command", name);
  return man_page(table, *found, version());
}

} // namespace

void add_schema(CLI::App& app, Action& action) {
  const auto what = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("schema", "The JSON Schema of scenes or campaigns, for editors");
  command->add_option("of", *what, "Of which: scene or campaign")
      ->required()
      ->check(CLI::IsMember({"scene", "campaign"}));
  command->footer(
      R"(Made of what the readers themselves ask for: an editor that has it completes keys, says what each
is for, and marks what is unknown or of a wrong type. What holds between values `wingspread check`
knows.

Example:
  wingspread schema scene > scene.schema.json)");
  command->callback([what, &action] {
    action = [what] {
      fmt::print("{}", json_text((*what == "scene" ? scene_schema() : campaign_schema()).schema));
      return exit_code::done;
    };
  });
}

// What these print is made while the command line is understood, for it is the command line.

void add_completion(CLI::App& app, Action& action) {
  const auto shell = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("completion", "What makes a shell complete the command line")->group("");
  command->add_option("shell", *shell, "Which shell")
      ->required()
      ->check(CLI::IsMember(std::vector<std::string>(shell_names.begin(), shell_names.end())));
  command->callback([shell, &app, &action] {
    const auto index = std::ranges::find(shell_names, *shell) - shell_names.begin();
    action = printing(completion_script(command_table(app), static_cast<Shell>(index)));
  });
}

void add_man(CLI::App& app, Action& action) {
  const auto name = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("man", "A man page")->group("");
  command->add_option("--of", *name, "Of which command; of the program itself without");
  command->callback(
      [name, &app, &action] { action = printing(page_of(command_table(app), *name)); });
}

} // namespace wingspread
