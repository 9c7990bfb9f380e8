#include "montecarlo/campaign/campaign_json.hpp"
#include "montecarlo/campaign/describe.hpp"
#include "montecarlo/commands/commands.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <variant>

namespace wingspread {
namespace {

int check(const std::filesystem::path& file) {
  const std::variant<Scene, Campaign> read = read_file(file);
  const auto text = std::visit([](const auto& spec) { return describe(spec); }, read);
  fmt::print("{}{}", text, text.ends_with('\n') ? "" : "\n");
  return exit_code::done;
}

} // namespace

void add_check(CLI::App& app, Action& action) {
  const auto file = std::make_shared<std::filesystem::path>();
  CLI::App* command =
      app.add_subcommand("check", "Validate a scene or a campaign, and say what it holds");
  command->add_option("file", *file, "The scene or campaign, a JSON file")->required();
  command->footer(
      R"(All problems are reported together, each with its place; the exit code is then 2.

Example:
  wingspread check campaign.json)");
  command->callback([file, &action] { action = [file] { return check(*file); }; });
}

} // namespace wingspread
