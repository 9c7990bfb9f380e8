#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/interfaces/commands/command_setup.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"
#include "montecarlo/model/schema/schema.hpp"
#include "montecarlo/report/text/method_list.hpp"
#include "montecarlo/results/results_folder/version.hpp"

#include <fmt/format.h>

namespace wingspread {
namespace {

struct MethodsOptions {
  bool json = false;
};

int list_methods(const MethodsOptions& options) {
  fmt::print("{}", options.json ? json_text(methods_json(methods())) : methods_text(methods()));
  return exit_code::done;
}

void add_methods_options(CLI::App& command, MethodsOptions& options) {
  command.add_flag("--json", options.json, "Print JSON, not text");
  command.footer("Example:\n  wingspread methods");
}

struct SchemaOptions {
  std::string of;
};

int print_schema(const SchemaOptions& options) {
  const bool scene = options.of == "scene";
  fmt::print("{}", json_text((scene ? scene_schema() : campaign_schema()).schema));
  return exit_code::done;
}

void add_schema_options(CLI::App& command, SchemaOptions& options) {
  one_of(command.add_option("of", options.of, "Which schema"), {"scene", "campaign"})
      ->type_name("scene|campaign")
      ->required();
  command.footer(
      R"(An editor with this schema completes keys, describes them, and marks unknown keys and wrong types.
`wingspread check` also checks values against each other.

Example:
  wingspread schema scene > scene.schema.json

A file with "$schema": "scene.schema.json" tells editors its schema; wingspread ignores the key.)");
}

struct NoOptions {};

int print_version(const NoOptions& /*options*/) {
  fmt::print("{}\n", version_text());
  return exit_code::done;
}

} // namespace

std::string version_text() { return fmt::format("wingspread {}", version()); }

void add_methods(CLI::App& app, Action& action) {
  add_command<MethodsOptions>(app, action, "methods",
                              "List the integration methods and their properties",
                              add_methods_options, list_methods);
}

void add_schema(CLI::App& app, Action& action) {
  add_command<SchemaOptions>(app, action, "schema",
                             "Print the JSON Schema of scenes or campaigns, for editors",
                             add_schema_options, print_schema);
}

void add_version(CLI::App& app, Action& action) {
  const auto add_options = [](CLI::App& command, NoOptions&) {
    command.footer("Example:\n  wingspread version");
  };
  add_command<NoOptions>(app, action, "version", "Print the program's version", add_options,
                         print_version);
}

} // namespace wingspread
