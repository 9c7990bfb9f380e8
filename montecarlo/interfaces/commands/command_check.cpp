#include "montecarlo/interfaces/commands/commands.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/describe.hpp"
#include "montecarlo/model/input_checks/check_input.hpp"
#include "montecarlo/model/input_checks/placement.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <variant>
#include <vector>

namespace wingspread {
namespace {

struct CheckOptions {
  std::filesystem::path file;
  std::vector<std::string> set;
  bool strict = false;
};

std::variant<Scene, Campaign> read_changed(const CheckOptions& options) {
  std::variant<Scene, Campaign> read = read_file(options.file);
  if (auto* campaign = std::get_if<Campaign>(&read))
    change_scene(*campaign, options.set);
  else
    read = changed_scene(std::get<Scene>(std::move(read)), options.set);
  return read;
}

/// What it holds, and where its bodies are.
std::string text_of(const Scene& scene) { return describe(scene) + describe_placement(scene); }
std::string text_of(const Campaign& campaign) {
  return describe(campaign) + describe_placement(campaign.scene);
}

std::vector<InputWarning> check_file(const std::variant<Scene, Campaign>& read,
                                     const std::filesystem::path& file) {
  if (const Scene* scene = std::get_if<Scene>(&read)) return check_input(*scene, {}, file);
  return check_input(std::get<Campaign>(read), file);
}

int check(const CheckOptions& options) {
  const std::variant<Scene, Campaign> read = read_changed(options);
  const std::vector<InputWarning> notices = check_file(read, options.file);
  if (options.strict) heed(notices, true);
  fmt::print("{}", std::visit([](const auto& spec) { return text_of(spec); }, read));
  heed(notices, false); // last, where it is seen
  return exit_code::done;
}

} // namespace

void add_check(CLI::App& app, Action& action) {
  const auto options = std::make_shared<CheckOptions>();
  CLI::App* command = app.add_subcommand(
      "check", "Validate a scene or a campaign; say what it holds, and what looks wrong");
  command->add_option("file", options->file, "The scene or campaign, a JSON file")->required();
  add_strict_option(*command, options->strict);
  add_set_option(*command, options->set);
  command->footer(
      R"(All problems are reported together, each with its place; the exit code is then 2. What can be
run but looks wrong is warned of on standard error: angles in degrees, springs that push away from
their latch, bodies in each other's place, laws that turn a sign, and the like.

Example:
  wingspread check campaign.json)");
  command->callback([options, &action] { action = [options] { return check(*options); }; });
}

} // namespace wingspread
