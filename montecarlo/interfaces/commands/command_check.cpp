#include "montecarlo/analyses/margin/margin_study.hpp"
#include "montecarlo/engine/runs/campaign_check.hpp"
#include "montecarlo/engine/runs/run_cost.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/nearest.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/foundation/platform/standard_error.hpp"
#include "montecarlo/interfaces/commands/command_setup.hpp"
#include "montecarlo/interfaces/library/single_run.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"
#include "montecarlo/interfaces/terminal/output_file.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/describe.hpp"
#include "montecarlo/model/input_checks/check_input.hpp"
#include "montecarlo/model/input_checks/placement.hpp"
#include "montecarlo/model/static_margins/static_margin_report.hpp"
#include "montecarlo/report/drawing/wing_drawing.hpp"
#include "montecarlo/report/text/modes_report.hpp"
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

/// Describes the scene or the campaign, and the positions and masses of its bodies.
std::string text_of(const Scene& scene) { return describe(scene) + describe_placement(scene); }
std::string text_of(const Campaign& campaign) {
  std::vector<std::pair<std::string, Scene>> wings;
  for (const Campaign& each : campaigns_of(campaign))
    wings.emplace_back(each.of_case, nominal_scene(each));
  return describe(campaign) + describe_placement(campaign.scene) +
         nominal_margins_text(wings, campaign.motorization);
}

NominalRuns try_read(const Scene& scene) { return try_nominal(scene, {}); }
NominalRuns try_read(const Campaign& campaign) { return try_nominal(campaign); }

const Scene& scene_of(const Scene& scene) { return scene; }
const Scene& scene_of(const Campaign& campaign) { return campaign.scene; }

/// The cost of `margin`: bounds of its number of runs, and their time if each takes as long as the nominal run. Empty
/// without a /margin.
std::string margin_cost(const Scene& /*scene*/, const NominalRuns& /*tried*/) { return ""; }
std::string margin_cost(const Campaign& campaign, const NominalRuns& tried) {
  if (!campaign.margin || campaign.requirements.empty()) return "";
  const MarginRuns runs = margin_runs(campaign);
  return fmt::format("cost of margin: at least {} runs ({}), at most {} ({}), by the "
                     "nominal run's time\n",
                     runs.least, time_of_runs(tried, runs.least), runs.most,
                     time_of_runs(tried, runs.most));
}

/// Writes the picture, which may replace an earlier one.
void draw(const std::filesystem::path& picture, const Scene& scene) {
  if (picture.empty()) return;
  write_file(picture, draw_wing(scene));
  fmt::print("{}\n", picture.string());
}

std::vector<InputWarning> check_file(const std::variant<Scene, Campaign>& read,
                                     const std::filesystem::path& file) {
  if (const Scene* scene = std::get_if<Scene>(&read)) return check_input(*scene, {}, file);
  return check_campaign(std::get<Campaign>(read), file);
}

int check(const CheckOptions& options) {
  refuse_overwriting(options.draw, {options.file}, "--draw");
  const std::variant<Scene, Campaign> read = read_changed(options);
  const std::vector<InputWarning> warnings = check_file(read, options.file);
  if (options.strict) print_warnings(warnings, true);
  const NominalRuns tried = std::visit([](const auto& spec) { return try_read(spec); }, read);
  const std::string text = std::visit([](const auto& spec) { return text_of(spec); }, read);
  const std::string margin =
      std::visit([&](const auto& spec) { return margin_cost(spec, tried); }, read);
  fmt::print("{}", wrapped_lines(text + "cost: " + tried.cost + '\n' + margin));
  draw(options.draw, std::visit([](const auto& spec) { return scene_of(spec); }, read));
  print_warnings(warnings, false); // last, where the user sees them
  for (const std::string& line : tried.notes) print_message("note: {}\n", line);
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

It also prints where each body is, the masses, and what the runs of `run` and `margin` will cost,
estimated from one nominal run and the draws of up to eight; files and statistics add to it.
A note on standard error names each case whose nominal wing does not deploy, and why.
--draw writes a picture for a browser: bodies, hinge axes, the sense in which each spring turns its
hinge, and names; an existing file is replaced. Look at the wing before you run it.

Example:
  wingspread check campaign.json --draw wing.svg
  wingspread check campaign.json --case cold)");
}

struct ModesOptions {
  std::filesystem::path file;
  api::Settings settings; ///< only set and of_case
  std::vector<std::string> latched;
  bool json = false;
};

/// The indices of the named hinges; nothing if none is named. @throws SpecError with all unknown names
std::optional<std::vector<int>> latched_hinges(const Scene& scene,
                                               const std::vector<std::string>& names) {
  if (names.empty()) return std::nullopt;
  std::vector<Problem> problems;
  std::vector<std::string> known;
  std::vector<int> found;
  for (const Hinge& hinge : scene.hinges)
    if (hinge.latch) known.push_back(hinge.name);
  for (const std::string& name : names) {
    const auto hinge = std::ranges::find(scene.hinges, name, &Hinge::name);
    if (hinge != scene.hinges.end() && hinge->latch)
      found.push_back(static_cast<int>(hinge - scene.hinges.begin()));
    else
      problems.push_back({"", "--latched", fmt::format("\"{}\"", name),
                          "hinges that have a latch" + did_you_mean(name, known)});
  }
  if (!problems.empty()) throw SpecError(std::move(problems));
  return found;
}

int modes(const ModesOptions& options) {
  const Scene scene = task_of(read_file(options.file), options.settings).scene;
  const std::optional<WingModes> found =
      natural_modes(scene, latched_hinges(scene, entries_of("--latched", options.latched)));
  if (!found)
    throw SpecError({{options.file.string(), "", "a wing without rest",
                      "latches, stops, springs or joints that end each hinge's turning, from the "
                      "latched angles on"}});
  fmt::print("{}", options.json ? json_text(modes_json(*found)) : modes_text(*found));
  return exit_code::done;
}

void add_modes_options(CLI::App& command, ModesOptions& options) {
  command.add_option("file", options.file, "A scene, or a campaign for its nominal scene")
      ->required();
  command
      .add_option(
          "--latched", options.latched,
          "Hinges whose latches are engaged; others with a latch are held stowed. Default: all")
      ->type_name("HINGE,...");
  command.add_flag("--json", options.json, "Print the modes as JSON, with flexible bodies' joints");
  add_set_option(command, options.settings.set);
  add_case_option(command, options.settings.of_case, without_case);
  command.footer(
      R"(Prints the natural frequencies, damping ratios and shapes of small swings about rest: latches,
springs, joints, loops, motors at their last rate and gravity, no friction but the viscous one, no
power-law damper, no air.
A mode that nothing holds has frequency 0. In a campaign "outputs": ["frequency"] gives every run
the frequencies of its draw, mode_1.frequency and so on.

Example:
  wingspread modes three_panel.json
  wingspread modes campaign.json --latched root,mid --json)");
}

} // namespace

void add_modes(CLI::App& app, Action& action) {
  add_command<ModesOptions>(app, action, "modes",
                            "Print the natural frequencies of the deployed wing", add_modes_options,
                            modes);
}

void add_check(CLI::App& app, Action& action) {
  add_command<CheckOptions>(app, action, "check",
                            "Validate and describe a scene or a campaign; warn of what looks wrong",
                            add_check_options, check);
}

} // namespace wingspread
