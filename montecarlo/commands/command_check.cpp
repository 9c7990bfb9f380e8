#include "montecarlo/campaign/campaign_json.hpp"
#include "montecarlo/campaign/describe.hpp"
#include "montecarlo/commands/command_options.hpp"
#include "montecarlo/commands/commands.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <variant>

namespace wingspread {
namespace {

struct CheckOptions {
  std::filesystem::path file;
  std::vector<std::string> set;
};

std::variant<Scene, Campaign> read_changed(const CheckOptions& options) {
  std::variant<Scene, Campaign> read = read_file(options.file);
  if (auto* campaign = std::get_if<Campaign>(&read))
    change_scene(*campaign, options.set);
  else
    read = changed_scene(std::get<Scene>(std::move(read)), options.set);
  return read;
}

int check(const CheckOptions& options) {
  const std::variant<Scene, Campaign> read = read_changed(options);
  const auto text = std::visit([](const auto& spec) { return describe(spec); }, read);
  fmt::print("{}{}", text, text.ends_with('\n') ? "" : "\n");
  return exit_code::done;
}

} // namespace

void add_check(CLI::App& app, Action& action) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App* command =
      app.add_subcommand("check", "Validate a scene or a campaign, and say what it holds");
  command->add_option("file", options->file, "The scene or campaign, a JSON file")->required();
  add_set_option(*command, options->set);
  command->footer(
      R"(All problems are reported together, each with its place; the exit code is then 2.

Example:
  wingspread check campaign.json)");
  command->callback([options, &action] { action = [options] { return check(*options); }; });
}

} // namespace wingspread
