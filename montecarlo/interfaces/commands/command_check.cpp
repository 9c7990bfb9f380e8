#include "montecarlo/engine/runs/run_cost.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/interfaces/commands/command_setup.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"
#include "montecarlo/interfaces/terminal/output_file.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/describe.hpp"
#include "montecarlo/model/input_checks/check_input.hpp"
#include "montecarlo/model/input_checks/placement.hpp"
#include "montecarlo/model/static_margins/static_margin_report.hpp"
#include "montecarlo/report/drawing/wing_drawing.hpp"
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
  std::filesystem::path file, draw;
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

std::string cost_line(const std::string& cost) { return "cost: " + cost + '\n'; }

/// Describes the scene or the campaign, the positions and masses of its bodies, and what its runs will cost.
std::string text_of(const Scene& scene) {
  return describe(scene) + describe_placement(scene) + cost_line(describe_cost(scene, {}));
}
std::string text_of(const Campaign& campaign) {
  std::vector<std::pair<std::string, Scene>> wings;
  for (const Campaign& each : campaigns_of(campaign))
    wings.emplace_back(each.of_case, nominal_scene(each));
  return describe(campaign) + describe_placement(campaign.scene) +
         nominal_margins_text(wings, campaign.motorization) + cost_line(describe_cost(campaign));
}

const Scene& scene_of(const Scene& scene) { return scene; }
const Scene& scene_of(const Campaign& campaign) { return campaign.scene; }

/// Writes the picture, which may replace an earlier one.
void draw(const std::filesystem::path& picture, const Scene& scene) {
  if (picture.empty()) return;
  write_file(picture, draw_wing(scene));
  fmt::print("{}\n", picture.string());
}

std::vector<InputWarning> check_file(const std::variant<Scene, Campaign>& read,
                                     const std::filesystem::path& file) {
  if (const Scene* scene = std::get_if<Scene>(&read)) return check_input(*scene, {}, file);
  return check_input(std::get<Campaign>(read), file);
}

int check(const CheckOptions& options) {
  refuse_overwriting(options.draw, {options.file}, "--draw");
  const std::variant<Scene, Campaign> read = read_changed(options);
  const std::vector<InputWarning> warnings = check_file(read, options.file);
  if (options.strict) print_warnings(warnings, true);
  fmt::print("{}", std::visit([](const auto& spec) { return text_of(spec); }, read));
  draw(options.draw, std::visit([](const auto& spec) { return scene_of(spec); }, read));
  print_warnings(warnings, false); // last, where the user sees them
  return exit_code::done;
}

void add_check_options(CLI::App& command, CheckOptions& options) {
  command.add_option("file", options.file, "The scene or campaign, a JSON file")->required();
  add_strict_option(command, options.strict);
  add_set_option(command, options.set);
  add_case_option(command, options.of_case);
  command
      .add_option("--draw", options.draw,
                  "Draw the wing stowed, half-way and deployed into this SVG file")
      ->type_name("FILE");
  command.footer(
      R"(Reports all errors together, each with its place in the file; the exit code is then 2. Warnings on
standard error name input that can be run but looks wrong: angles in degrees, springs that push
away from their latch, bodies in the same place, laws that change a sign, and the like. For a
campaign it prints the static margins by each standard: of every case, or of the one in --case.

It also prints where each body is, the masses, and what the runs will cost, estimated from one
nominal run. --draw writes a picture for a browser: bodies, hinge axes, the sense in which each
spring turns its hinge, and names. Look at the wing before you run it.

Example:
  wingspread check campaign.json --draw wing.svg
  wingspread check campaign.json --case cold)");
}

} // namespace

void add_check(CLI::App& app, Action& action) {
  add_command<CheckOptions>(app, action, "check",
                            "Validate and describe a scene or a campaign; warn of what looks wrong",
                            add_check_options, check);
}

} // namespace wingspread
