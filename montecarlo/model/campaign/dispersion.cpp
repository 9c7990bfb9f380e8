#include "montecarlo/model/campaign/dispersion.hpp"

#include "distributions/random_stream.hpp"
#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/model/campaign/distribution_json.hpp"
#include "montecarlo/model/scene_file/torque_json.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace wingspread {
namespace {

constexpr std::array<std::string_view, 6> columns_of_runs{"run",         "status", "peaks_final",
                                                          "latch_order", "reason", "deployed"};
constexpr std::size_t most_dispersions = 10'000;
constexpr std::string_view expected_drive_table =
    "a table: an object with at and value; a monotone cubic between points, constant beyond";

/// A dispersion and its place in the document.
struct Sourced {
  Dispersion dispersion;
  JsonCursor at;
};

bool is_column_name(const std::string& name) {
  return !name.empty() && name.find_first_of(",\"") == std::string::npos &&
         !has_control_characters(name);
}

bool is_taken(const std::string& name) {
  return std::ranges::find(columns_of_runs, name) != columns_of_runs.end() ||
         parse_output_name(name).kind != nullptr;
}

/// The paths of an `each`, which may be one string or a list.
std::vector<JsonCursor> paths_of_each(const JsonCursor& each) {
  if (!each.value().is_array()) return {each};
  if (each.value().empty()) each.refuse("a path, or an array of at least one");
  return each.elements();
}

/// Adds a parameter to the copy for its body, hinge or synchronisation; makes the copy if there is none.
void add_match(const ParameterMatch& match, const Dispersion& pattern,
               std::vector<Dispersion>& copies) {
  const auto owner = [](const Dispersion& each) { return each.targets.front().index; };
  auto copy = std::ranges::find(copies, match.parameter.index, owner);
  if (copy == copies.end()) {
    copies.push_back(pattern);
    copies.back().name += "." + match.name;
    copy = copies.end() - 1;
  }
  copy->targets.push_back(match.parameter);
}

/// Copies the dispersion for each body, hinge or synchronisation that `each` matches.
std::vector<Dispersion> expand(const JsonCursor& each, const Scene* scene,
                               const Dispersion& pattern) {
  std::vector<Dispersion> copies;
  std::set<SceneParameter> seen;
  for (const JsonCursor& path : paths_of_each(each))
    for (const ParameterMatch& match : read_path(path, scene)) {
      if (match.name.empty()) {
        path.refuse("the path of a body's or a hinge's parameter (\"to\" takes the base's)");
      } else if (!seen.empty() && seen.begin()->owner != match.parameter.owner) {
        path.refuse(describe_value(path.value()) + " beside parameters of other objects",
                    "parameters of bodies only, of hinges only or of synchronisations only");
        break;
      } else if (!seen.insert(match.parameter).second) {
        path.refuse_repeated(path_of(*scene, match.parameter), "each parameter once");
      } else {
        add_match(match, pattern, copies);
      }
    }
  return copies;
}

/// Reads a table's `at`.
bool read_knots(JsonObject& table, std::vector<double>& at_draws) {
  const std::string expected = fmt::format("an array of 2 to {} numbers, ascending", most_knots);
  const auto at = table.require("at", expected);
  if (!at || !at->read(at_draws, expected)) return false;
  if (!can_be_knots(at_draws.size())) return at->refuse(expected);
  return check_ascending(*at, at_draws, "draw");
}

/// @param unit     nothing: unknown
/// @param resolved the table's JSON; receives the values in SI
void read_drive_table(const JsonCursor& at, std::optional<std::string_view> unit, Driven& driven,
                      Json& resolved) {
  JsonObject object(at, expected_drive_table);
  std::vector<double> draws, values;
  bool good = read_knots(object, draws);
  const auto value = object.require("value", "an array with a number for each draw");
  if (value) value->note_quantity("in the parameter's unit, of a scale a factor");
  const std::size_t before = at.problems().size();
  good = good && value &&
         read_column_beside(*value, draws, "draws", Dimension{unit.value_or("")}, values);
  if (!unit) drop_quantities(before, at.problems());
  object.refuse_others();
  if (!good) return;
  resolved = {{"at", draws}, {"value", values}};
  driven.table = Curve(std::move(draws), std::move(values), Interpolation::monotone);
  if (!is_finite(driven.table))
    at.refuse("a curve that overflows", "draws further apart, or smaller values");
}

Driven read_driven(const JsonCursor& at, const Scene* scene, Json& resolved) {
  Driven driven;
  JsonObject object(at, "what the draw drives: an object with to, apply and table");
  if (const auto to = object.require("to", "an array of at least one parameter's path"))
    driven.targets = read_paths(*to, scene);
  object.required_choice("apply", driven.apply, apply_names);
  std::optional<std::string_view> unit = "";
  if (driven.apply != Apply::scale && at.value().is_object())
    unit = scene ? common_unit(at.value().value("to", Json()), *scene) : std::nullopt;
  if (const auto table = object.require("table", expected_drive_table))
    read_drive_table(*table, unit, driven, resolved["table"]);
  object.refuse_others();
  return driven;
}

void read_through(const JsonCursor& at, const Scene* scene, Dispersion& dispersion,
                  Json& resolved) {
  if (!at.value().is_array() || at.value().empty())
    at.refuse("an array of what the draw drives, at least one");
  for (std::size_t i = 0; const JsonCursor& element : at.elements())
    dispersion.through.push_back(read_driven(element, scene, resolved[i++]));
}

/// Reads the targets. Returns the dispersion, or its copies for an `each`.
std::vector<Dispersion> read_targets(JsonObject& object, const Scene* scene, Dispersion dispersion,
                                     Json& resolved) {
  const auto to = object.find("to"), each = object.find("each"), through = object.find("through");
  std::vector<std::string_view> given;
  if (to) given.emplace_back("\"to\"");
  if (each) given.emplace_back("\"each\"");
  if (through) given.emplace_back("\"through\"");
  if (through) {
    if (const auto apply = object.find("apply"))
      apply->refuse("no apply beside a \"through\": each of its tables has its own");
    read_through(*through, scene, dispersion, resolved["through"]);
  } else {
    object.required_choice("apply", dispersion.apply, apply_names);
  }
  if (object.is_object() && given.size() != 1)
    object.at().refuse(given.empty() ? "neither \"to\" nor \"each\" nor \"through\""
                                     : fmt::format("{} together", fmt::join(given, " and ")),
                       "one of them");
  else if (each)
    return expand(*each, scene, dispersion);
  else if (to)
    dispersion.targets = read_paths(*to, scene);
  return {std::move(dispersion)};
}

/// Reads the effect of one column of rows.
Dispersion read_row_column(const JsonCursor& at, const std::string& name, Apply apply,
                           const Scene* scene, Json& resolved) {
  Dispersion column{name, {}, apply, {}};
  if (at.value().is_string()) {
    for (const ParameterMatch& match : read_path(at, scene))
      column.targets.push_back(match.parameter);
  } else if (at.value().is_array()) {
    column.targets = read_paths(at, scene);
  } else {
    JsonObject object(at, "a path, an array of paths, or an object with to or through");
    if (const auto through = object.find("through")) {
      read_through(*through, scene, column, resolved["through"]);
    } else {
      object.optional_choice("apply", column.apply, apply_names);
      if (const auto to = object.require("to", "an array of at least one parameter's path"))
        column.targets = read_paths(*to, scene);
    }
    object.refuse_others();
  }
  return column;
}

/// The SI unit of a column's values; empty for factors, tables and parameters of several units; nullopt without a target.
std::optional<std::string_view> unit_of_column(const Dispersion& column) {
  if (column.apply == Apply::scale || !column.through.empty()) return "";
  if (column.targets.empty()) return std::nullopt;
  const std::string_view first = unit_of(column.targets.front());
  const bool common = std::ranges::all_of(
      column.targets, [&](const SceneParameter& target) { return unit_of(target) == first; });
  return common ? first : "";
}

/// Reads the values of all columns: from the file, or from "values" as a resolved campaign has them.
void read_row_values(JsonObject& object, const std::filesystem::path& directory,
                     std::vector<Dispersion>& columns, Json& resolved) {
  std::string name;
  const auto values = object.find("values"), file = object.find("file");
  if (values.has_value() == file.has_value())
    return void(object.at().refuse(values ? "both values and a file" : "neither a file nor values",
                                   "one of them"));
  if (file && !file->read(name, "a string, the name of a CSV file")) return;
  resolved["values"] = Json::object();
  std::optional<JsonObject> list;
  if (values)
    list.emplace(*values, "an object with the values of each column"), list->keys_are_names();
  std::size_t rows = 0;
  for (Dispersion& column : columns) {
    Empirical law;
    const std::size_t before = object.at().problems().size();
    if (file)
      read_csv_column(object.at(), name, column.name, directory, unit_of_column(column),
                      law.values);
    else
      list->required(column.name, law.values, "an array of numbers");
    if (object.at().problems().size() > before) continue;
    if (rows == 0) rows = law.values.size();
    if (law.values.empty() || law.values.size() != rows)
      object.at().refuse(
          fmt::format("{} rows in the column \"{}\"", law.values.size(), column.name),
          rows == 0 ? "at least one" : fmt::format("{}, as in the others", rows));
    resolved["values"][column.name] = law.values;
    column.distribution.law = std::move(law);
  }
  if (list) list->refuse_others();
}

/// Reads a dispersion whose columns are drawn together, a row a run.
std::vector<Dispersion> read_rows(const JsonCursor& at, const std::string& name, const Scene* scene,
                                  const std::filesystem::path& directory, Json& resolved) {
  std::vector<Dispersion> columns;
  JsonObject object(at, "rows: an object with file, columns and apply");
  if (!object.is_object()) return columns;
  Apply apply = Apply::set;
  object.required_choice("apply", apply, apply_names);
  const auto named = object.require("columns", "an object with paths by the names of columns");
  if (named) {
    if (!named->value().is_object() || named->value().empty())
      named->refuse("an object with paths by the names of columns, at least one");
    else
      for (const auto& [column, effect] : named->value().items()) {
        const JsonCursor place = named->member(column);
        if (!is_column_name(column))
          place.refuse(fmt::format("the column \"{}\"", column),
                       "a name, not empty, without commas, quotes and control characters");
        columns.push_back(
            read_row_column(place, column, apply, scene, resolved["columns"][column]));
        columns.back().rows = name;
      }
    named->note(Question::What::names, "");
  }
  resolved.erase("file");
  read_row_values(object, directory, columns, resolved);
  object.refuse_others();
  return columns;
}

std::vector<Dispersion> read_dispersion(const JsonCursor& at, const Scene* scene,
                                        const std::filesystem::path& directory, Json& resolved) {
  Dispersion dispersion;
  JsonObject object(at, "a dispersion: an object");
  object.required("name", dispersion.name,
                  "a string, not empty, without commas, quotes and control characters",
                  is_column_name);
  if (const auto rows = object.find("rows")) {
    auto columns = read_rows(*rows, dispersion.name, scene, directory, resolved["rows"]);
    object.refuse_others();
    return columns;
  }
  if (const auto law = object.require("distribution", "a distribution: an object with its type")) {
    dispersion.distribution = read_distribution(*law, directory, unit_of_draws(at.value(), scene));
    resolved["distribution"] = write_distribution(dispersion.distribution);
  }
  auto read = read_targets(object, scene, std::move(dispersion), resolved);
  object.refuse_others();
  return read;
}

/// The name of the `rows` or the `each` that a dispersion comes from; else empty.
std::string name_of_origin(const Sourced& sourced) {
  if (!sourced.dispersion.rows.empty()) return sourced.dispersion.rows;
  const Json& entry = sourced.at.value();
  const bool is_named =
      entry.contains("each") && entry.contains("name") && entry["name"].is_string();
  return is_named && entry["name"] != sourced.dispersion.name ? entry["name"] : Json("");
}

/// Refuses names of other columns and of other dispersions, and names with the random stream of another name.
void check_names(const std::vector<Sourced>& all) {
  std::map<std::uint64_t, std::string> streams;
  const auto check = [&](const std::string& name, const JsonCursor& place) {
    if (name.empty()) return; // has a problem already
    const auto refuse = [&](const std::string& found, std::string_view expected) {
      place.refuse(fmt::format("\"{}\", {}", name, found), expected, "/name");
    };
    const auto [same, is_new] = streams.emplace(stream_name(name).hash, name);
    if (is_taken(name))
      refuse("the name of a column of the results", "another name");
    else if (!is_new && same->second == name)
      refuse("the name of another dispersion too", "a name of its own");
    else if (!is_new)
      refuse(fmt::format("which has the random stream of \"{}\"", same->second), "another name");
  };
  std::string before; // the entry of the dispersion before
  for (const Sourced& each : all) {
    if (each.at.pointer() != before) check(name_of_origin(each), each.at);
    before = each.at.pointer(), check(each.dispersion.name, each.at);
  }
}

/// Refuses each "set" of a parameter that an earlier dispersion has changed.
void check_order(const std::vector<Sourced>& all, const Scene& scene) {
  std::map<SceneParameter, std::string> writers;
  for (const auto& [dispersion, at] : all)
    for_each_effect(dispersion, [&, &by = dispersion, &place = at](Apply how, const auto& targets,
                                                                   const Curve*) {
      for (const SceneParameter& target : targets) {
        const auto [writer, first] = writers.emplace(target, by.name);
        if (!first && how == Apply::set)
          place.refuse(fmt::format("\"set\" of {} after \"{}\" has changed it",
                                   path_of(scene, target), writer->second),
                       "\"set\" first: it overwrites earlier changes",
                       by.through.empty() ? "/apply" : "/through");
      }
    });
}

} // namespace

Dispersions read_dispersions(const JsonCursor& at, const Scene* scene,
                             const std::filesystem::path& directory) {
  if (!at.value().is_array()) at.refuse("an array of dispersions");
  Dispersions dispersions{{}, at.value()};
  std::vector<Sourced> all;
  for (std::size_t i = 0; const JsonCursor& element : at.elements(most_dispersions))
    for (Dispersion& read : read_dispersion(element, scene, directory, dispersions.resolved[i++]))
      all.push_back({std::move(read), element});
  if (all.size() > most_dispersions)
    at.refuse(fmt::format("{} dispersions", all.size()),
              fmt::format("at most {}", most_dispersions));
  check_names(all);
  if (scene) check_order(all, *scene);
  for (Sourced& sourced : all) dispersions.list.push_back(std::move(sourced.dispersion));
  return dispersions;
}

Coordinates coordinates_of(std::span<const Dispersion> dispersions) {
  Coordinates all;
  for (const Dispersion& dispersion : dispersions) {
    const std::string& name = dispersion.rows.empty() ? dispersion.name : dispersion.rows;
    const bool shared = !dispersion.rows.empty() && !all.names.empty() && all.names.back() == name;
    if (!shared) all.names.push_back(name);
    all.of.push_back(all.names.size() - 1);
  }
  return all;
}

void apply_to(double& parameter, Apply how, double value) {
  switch (how) {
  case Apply::set:
    parameter = value;
    break;
  case Apply::scale:
    parameter *= value;
    break;
  case Apply::add:
    parameter += value;
    break;
  }
}

std::vector<SharedTarget> shared_targets(std::span<const Dispersion> dispersions,
                                         const Scene& scene) {
  constexpr std::array<std::string_view, 3> verbs{"sets", "scales", "adds"};
  std::vector<SceneParameter> order;
  std::map<SceneParameter, std::vector<std::string>> draws;
  for (const Dispersion& dispersion : dispersions)
    for_each_effect(dispersion, [&](Apply how, const auto& targets, const Curve*) {
      for (const SceneParameter& target : targets) {
        if (draws[target].empty()) order.push_back(target);
        draws[target].push_back(
            fmt::format("{} {}", dispersion.name, verbs[static_cast<std::size_t>(how)]));
      }
    });
  std::vector<SharedTarget> shared;
  for (const SceneParameter& target : order) {
    if (draws[target].size() < 2) continue;
    const auto same = std::ranges::find(shared, draws[target], &SharedTarget::draws);
    if (same == shared.end())
      shared.push_back({{path_of(scene, target)}, draws[target]});
    else
      same->paths.push_back(path_of(scene, target));
  }
  return shared;
}

} // namespace wingspread
