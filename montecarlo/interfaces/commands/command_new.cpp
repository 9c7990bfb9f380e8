#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/foundation/formats/spec_error.hpp"
#include "montecarlo/foundation/platform/standard_error.hpp"
#include "montecarlo/interfaces/commands/command_setup.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"
#include "montecarlo/interfaces/terminal/design_questions.hpp"
#include "montecarlo/interfaces/terminal/examples.hpp"
#include "montecarlo/model/starter/starter.hpp"

#include <fmt/format.h>

#include <array>
#include <iostream>
#include <optional>
#include <string_view>
#include <unistd.h>
#include <utility>
#include <vector>

namespace wingspread {
namespace {

constexpr int many_panels = 14; // heuristic: from there on the trial deployments take seconds

struct NewOptions {
  WingDesign design;
  std::filesystem::path out;
  std::string example;
  bool designed = false; ///< whether an option gives a part of the design
};

/// A file to write: its name within the folder, and its text.
using NewFiles = std::vector<std::pair<std::string, std::string>>;

/// Writes the files, or nothing if one of them would replace another text.
void write_new_files(const std::filesystem::path& folder, const NewFiles& files) {
  std::vector<Problem> problems;
  for (const auto& [name, text] : files) {
    const std::filesystem::path file = folder / name;
    if (std::filesystem::exists(file) && read_text(file) != text)
      problems.push_back({"", "--out", '"' + file.string() + "\", an existing file",
                          "a new folder: this file would be lost"});
  }
  if (!problems.empty()) throw SpecError(std::move(problems));
  make_folder(folder, "a folder that can be made; --out DIR names another");
  for (const auto& [name, text] : files) {
    write_file(folder / name, text);
    fmt::print("{}\n", (folder / name).string());
  }
}

/// Prints the commands that come next.
void print_next(const std::filesystem::path& folder, std::string_view campaign) {
  const std::string file = shell_word((folder / campaign).string());
  const std::string results = shell_word((folder / "results").string());
  fmt::print("next:\n"
             "  wingspread check {0} --draw {1}\n"
             "  wingspread run {0} --out {2} --table\n"
             "  wingspread report {2}\n",
             file, shell_word((folder / "wing.svg").string()), results);
}

int copy_example(const NewOptions& options) {
  if (options.designed)
    throw SpecError({{"", "--example", "--example and numbers of a wing",
                      "either an example as it is, or a wing of your own"}});
  const Example example = read_example(options.example);
  const std::filesystem::path folder =
      options.out.empty() ? std::filesystem::path(example.name) : options.out;
  write_new_files(folder, example.files);
  print_next(folder, starter_campaign_file);
  return exit_code::done;
}

int make_new(const NewOptions& options) {
  if (!options.example.empty()) return copy_example(options);
  const bool asks = !options.designed && isatty(STDIN_FILENO) == 1;
  const std::optional<WingDesign> answered =
      asks ? ask_design(std::cin, std::cout) : std::optional(options.design);
  if (!answered) {
    fmt::print("\n"); // the line of the last question
    throw SpecError({{"", "questions", "the end of the input", "an answer; nothing is written"}});
  }
  const WingDesign& design = *answered;
  if (design.panels >= many_panels)
    print_message("the wing is deployed several times to choose its damper and its limits: with "
                  "{} panels this takes some minutes\n",
                  design.panels);
  const Starter starter = make_starter(design, command_of(design, options.out.string()));
  const std::filesystem::path folder =
      options.out.empty() ? std::filesystem::path(design.name) : options.out;
  write_new_files(folder, {{starter_scene_file, starter.scene},
                           {starter_campaign_file, starter.campaign},
                           {starter_page_file, starter.page}});
  if (!starter.deploys)
    print_message("warning: the nominal wing does not deploy in every case: stronger springs, "
                  "or less harness and friction; the requirements' limits are placeholders\n");
  fmt::print("{} explains each line\n", (folder / starter_page_file).string());
  print_next(folder, starter_campaign_file);
  return exit_code::done;
}

/// Adds an option whose text `read` accepts, or refuses with a message. Returns it.
template <class Read>
CLI::Option* add_number(CLI::App& command, NewOptions& options, std::string_view option,
                        std::string_view what, std::string_view unit, Read read) {
  const auto parse = [&options, read, name = std::string(option)](const std::string& text) {
    options.designed = true;
    if (const auto message = read(text, options.design)) throw CLI::ValidationError(name, *message);
  };
  return command.add_option_function<std::string>(std::string(option), parse, std::string(what))
      ->type_name(std::string(unit));
}

void add_design_options(CLI::App& command, NewOptions& options) {
  WingDesign& design = options.design;
  const auto designed = [&options](auto) { options.designed = true; };
  command.add_option("--name", design.name, "Name of the wing and of its folder")
      ->type_name("NAME")
      ->each(designed);
  within(command.add_option("--wings", design.wings, "Number of wings (2: on both sides)"), 1, 2)
      ->type_name("N")
      ->each(designed);
  within(command.add_option("--panels", design.panels, "Panels of a wing"), 1, most_panels)
      ->type_name("N")
      ->each(designed);
  CLI::Option* yoke = command.add_flag_function(
      "--yoke", [&options](std::int64_t) { options.designed = options.design.yoke = true; },
      "A yoke between the spacecraft and the first panel");
  for (const DesignNumber& number : design_numbers()) {
    CLI::Option* option =
        add_number(command, options, number.option,
                   fmt::format("{}, {}; default: {}", number.what, number.dimension.condition,
                               WingDesign().*number.value),
                   number.dimension.unit, [number](const std::string& text, WingDesign& into) {
                     return read_design_number(text, number, into);
                   });
    if (number.of_yoke) option->needs(yoke);
  }
  add_number(command, options, damper_option,
             "damper of the root hinge, ≥ 0; default: doubles the time, to a tenth", "N·m·s/rad",
             [](const std::string& text, WingDesign& into) { return read_damper(text, into); });
}

void add_new_options(CLI::App& command, NewOptions& options) {
  add_design_options(command, options);
  command.add_option("--example", options.example, "Copy a shipped example, e.g. yoke")
      ->type_name("NAME");
  command.add_option("--out", options.out, "The folder to write; default: the name")
      ->type_name("DIR");
  command.footer(
      R"(Writes scene.json (the wing), campaign.json (what varies, cases, requirements) and README.md, which
explains each line of both. Panels fold as a Z: flat in a stack when stowed, in line when deployed.
`check`, `run` and `report` take the files as they are; replace the numbers by your own.

Without an option for the wing it asks on a terminal. Numbers may have a unit: "1.8 m", "12 in*lbf".
The same options give the same bytes.

Example:
  wingspread new
  wingspread new --wings 2 --panels 4 --yoke --panel-mass "9 kg" --spring 1.5
  wingspread new --example yoke --out yoke)");
}

} // namespace

void add_new(CLI::App& app, Action& action) {
  add_command<NewOptions>(app, action, "new",
                          "Write a wing and a campaign of your own to start from, explained",
                          add_new_options, make_new);
}

} // namespace wingspread
