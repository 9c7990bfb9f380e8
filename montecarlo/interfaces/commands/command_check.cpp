#include "montecarlo/interfaces/commands/command_setup.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/describe.hpp"
#include "montecarlo/model/input_checks/check_input.hpp"
#include "montecarlo/model/input_checks/placement.hpp"
#include "montecarlo/model/static_margins/static_margin_report.hpp"
#include "montecarlo/results/results_folder/cases_folder.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace wingspread {
namespace {

struct CheckOptions {
  std::filesystem::path file;
  std::vector<std::string> set;
  std::string of_case;
  bool strict = false;
};

std::variant<Scene, Campaign> read_changed(const CheckOptions& options) {
  std::variant<Scene, Campaign> read = read_file(options.file);
  if (auto* campaign = std::get_if<Campaign>(&read)) {
    change_scene(*campaign, options.set);
    if (!options.of_case.empty()) *campaign = chosen_case(*campaign, options.of_case);
  } else {
    if (!options.of_case.empty()) (void)chosen_case(Campaign(), options.of_case);
    read = changed_scene(std::get<Scene>(std::move(read)), options.set);
  }
  return read;
}

/// Describes the scene or the campaign, and the positions of its bodies.
std::string text_of(const Scene& scene) { return describe(scene) + describe_placement(scene); }
std::string text_of(const Campaign& campaign) {
  std::vector<std::pair<std::string, Scene>> wings;
  for (const Campaign& each : campaigns_of(campaign))
    wings.emplace_back(each.of_case, nominal_scene(each));
  return describe(campaign) + describe_placement(campaign.scene) +
         nominal_margins_text(wings, campaign.motorization);
}

std::vector<InputWarning> check_file(const std::variant<Scene, Campaign>& read,
                                     const std::filesystem::path& file) {
  if (const Scene* scene = std::get_if<Scene>(&read)) return check_input(*scene, {}, file);
  return check_input(std::get<Campaign>(read), file);
}

int check(const CheckOptions& options) {
  const std::variant<Scene, Campaign> read = read_changed(options);
  const std::vector<InputWarning> warnings = check_file(read, options.file);
  if (options.strict) print_warnings(warnings, true);
  fmt::print("{}", std::visit([](const auto& spec) { return text_of(spec); }, read));
  print_warnings(warnings, false); // last, where the user sees them
  return exit_code::done;
}

void add_check_options(CLI::App& command, CheckOptions& options) {
  command.add_option("file", options.file, "The scene or campaign, a JSON file")->required();
  add_strict_option(command, options.strict);
  add_set_option(command, options.set);
  add_case_option(command, options.of_case);
  command.footer(
      R"(Reports all errors together, each with its place in the file; the exit code is then 2. Warnings on
standard error name input that can be run but looks wrong: angles in degrees, springs that push
away from their latch, bodies in the same place, laws that change a sign, and the like. For a
campaign it prints the static margins by each standard: of every case, or of the one in --case.

Example:
  wingspread check campaign.json
  wingspread check campaign.json --case cold)");
}

} // namespace

void add_check(CLI::App& app, Action& action) {
  add_command<CheckOptions>(app, action, "check",
                            "Validate and describe a scene or a campaign; warn of what looks wrong",
                            add_check_options, check);
}

} // namespace wingspread
