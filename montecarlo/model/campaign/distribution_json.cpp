#include "montecarlo/model/campaign/distribution_json.hpp"

#include "montecarlo/foundation/formats/csv.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/quantity.hpp"
#include "montecarlo/model/scene_file/scene_parameter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>
#include <sstream>
#include <utility>
#include <vector>

namespace wingspread {
namespace {

template <std::size_t... I> constexpr auto law_names(std::index_sequence<I...>) {
  return std::array{std::variant_alternative_t<I, Law>::type...};
}
constexpr std::make_index_sequence<std::variant_size_v<Law>> every_law;
constexpr auto type_names = law_names(every_law);

template <std::size_t... I> Law default_law(std::size_t type, std::index_sequence<I...>) {
  const std::array laws{Law(std::in_place_index<I>)...};
  return laws[type];
}

std::string expected_of(double, Range range) {
  switch (range) {
  case Range::positive:
    return "a number, > 0";
  case Range::non_negative:
    return "a number, ≥ 0";
  case Range::shape:
    return "a number, > 0 and ≤ 1e6";
  case Range::finite:
    break;
  }
  return "a number";
}

std::string expected_of(const std::vector<double>&, Range range) {
  return range == Range::finite ? "an array of numbers" : "an array of numbers, ≥ 0";
}

/// The parameters that have the unit of the draws.
constexpr std::array<std::string_view, 8> in_drawn_unit{"mean",  "std",   "lower",  "mode",
                                                        "upper", "scale", "values", "value"};

bool has_string(const Json& value) {
  if (!value.is_array()) return value.is_string();
  return std::ranges::any_of(value, [](const Json& each) { return each.is_string(); });
}

constexpr std::string_view drawn_unit = "in the unit of the parameter that is drawn";

/// Reads a number, or a string with a unit if the parameter has the draws' unit.
template <class T>
void read_parameter(JsonObject& object, std::string_view name, T& value, Range range,
                    std::string_view unit) {
  const auto at = object.find(name);
  const bool is_drawn = std::ranges::find(in_drawn_unit, name) != in_drawn_unit.end();
  if (at && is_drawn) at->note_quantity(drawn_unit);
  if (at && !unit.empty() && has_string(at->value()) && is_drawn)
    at->read(value, Dimension{unit});
  else
    object.required(name, value, expected_of(value, range));
}

template <class L> void read_parameters(JsonObject& object, L& law, std::string_view unit) {
  for (const auto& parameter : L::parameters())
    read_parameter(object, parameter.name, law.*parameter.member, parameter.range, unit);
}

double parse_cell(const CsvReader& reader, const std::string& cell, const std::string& column) {
  if (const auto value = parse_csv_number(cell)) return *value;
  throw reader.error(column, fmt::format("'{}'", cell), "a finite number");
}

/// The factor to SI of a column's unit in the header's brackets.
/// @param unit SI unit of the values; nothing: not known, and brackets mean nothing
/// @throws SpecError for a unit of another dimension
double factor_of(const std::string& header, std::optional<std::string_view> unit,
                 const CsvReader& reader, const std::string& column) {
  const std::string given = header_cell(header).unit;
  if (!unit || !is_unit(given)) return 1; // brackets of a name
  if (const auto factor = in_unit("1 " + given, *unit)) return *factor;
  throw reader.error(column, fmt::format("the unit \"{}\"", given),
                     unit->empty() ? "no unit" : "one such as " + units_like(*unit));
}

/// Reads one column of a CSV file with a header. @param unit see factor_of
/// @throws SpecError at the first problem
std::vector<double> read_column(std::istream& in, const std::string& file,
                                const std::string& column, std::optional<std::string_view> unit) {
  CsvReader reader(in, file);
  const bool has_header = reader.next();
  const std::vector<std::string> header = has_header ? reader.cells() : std::vector<std::string>{};
  const auto is_named = [&](const std::string& cell) {
    return cell == column || (is_unit(header_cell(cell).unit) && header_cell(cell).name == column);
  };
  const auto index =
      static_cast<std::size_t>(std::ranges::find_if(header, is_named) - header.begin());
  if (std::ranges::count_if(header, is_named) != 1)
    throw reader.error(column,
                       index == header.size() ? "no such column" : "the column more than once",
                       "the column once in the header");
  const double factor = factor_of(header[index], unit, reader, column);
  std::vector<double> values;
  while (reader.next()) {
    const std::vector<std::string>& cells = reader.cells();
    if (cells.size() == 1 && cells[0].empty() && header.size() > 1) continue; // an empty line
    if (cells.size() != header.size())
      throw reader.error("", fmt::format("{} cells", cells.size()),
                         fmt::format("{}, as in the header", header.size()));
    values.push_back(factor * parse_cell(reader, cells[index], column));
    if (!std::isfinite(values.back()))
      throw reader.error(column, fmt::format("'{}' in this unit", cells[index]),
                         "a number that is finite in SI");
  }
  return values;
}

void read_empirical(JsonObject& object, Empirical& law, const std::filesystem::path& directory,
                    std::string_view unit) {
  const bool from_file = object.find("file") || object.find("column");
  if (!from_file) return read_parameters(object, law, unit);
  if (object.find("values")) object.at().refuse("both values and a file", "either of them");
  std::string name, column;
  const bool named = object.required("file", name, "a string, the name of a CSV file");
  const bool picked = object.required("column", column, "a string, a column's name in the header");
  if (named && picked) read_csv_column(object.at(), name, column, directory, unit, law.values);
}

void read_truncation(const JsonCursor& at, std::optional<Truncation>& truncate,
                     std::string_view unit) {
  JsonObject object(at, "an object with lower and upper");
  truncate.emplace();
  for (const auto& [name, limit] :
       {std::pair{"lower", &truncate->lower}, std::pair{"upper", &truncate->upper}})
    if (object.find(name)) read_parameter(object, name, *limit, Range::finite, unit);
  if (object.is_object() && !object.find("lower") && !object.find("upper"))
    at.refuse("neither lower nor upper", "at least one of them");
  object.refuse_others();
}

/// Whether a fault is that of one parameter's range, and the parameter was read: it holds whatever the others are.
bool is_of_itself(const DistributionFault& fault, const Law& law, const std::string& pointer,
                  std::span<const Problem> unread) {
  const std::string name = fault.path.substr(0, fault.path.find('/'));
  const bool has_range = std::visit(
      [&]<class L>(const L&) {
        return std::ranges::any_of(L::parameters(), [&](const auto& parameter) {
          return parameter.name == name && parameter.range != Range::finite;
        });
      },
      law);
  const std::string at = pointer + "/" + name;
  return has_range && std::ranges::none_of(unread, [&](const Problem& problem) {
           return problem.pointer == at || problem.pointer.starts_with(at + "/");
         });
}

} // namespace

void read_csv_column(const JsonCursor& at, const std::string& name, const std::string& column,
                     const std::filesystem::path& directory, std::optional<std::string_view> unit,
                     std::vector<double>& values) {
  const std::filesystem::path path = directory / name;
  const auto text = read_text(path);
  if (!text) {
    at.refuse(fmt::format("no file that can be read at \"{}\"", path.string()), "a CSV file",
              "/file");
    return;
  }
  std::istringstream in(*text);
  try {
    values = read_column(in, path.string(), column, unit);
  } catch (const SpecError& error) {
    at.problems().insert(at.problems().end(), error.problems().begin(), error.problems().end());
  }
}

std::optional<std::string_view> common_unit(const Json& paths, const Scene& scene) {
  std::set<std::string_view> units;
  const auto add = [&](const Json& path) {
    if (!path.is_string()) return;
    for (const ParameterMatch& match : resolve(scene, path.get<std::string>()).matches)
      units.insert(unit_of(match.parameter));
  };
  if (paths.is_array())
    for (const Json& path : paths) add(path);
  else
    add(paths);
  if (units.empty()) return std::nullopt;
  return units.size() == 1 ? *units.begin() : "";
}

std::optional<std::string_view> unit_of_draws(const Json& spec, const Scene* scene) {
  if (!spec.is_object() || spec.value("apply", Json()) == "scale") return "";
  Json paths = Json::array();
  for (const char* key : {"to", "each"})
    if (const auto named = spec.find(key); named != spec.end())
      for (const Json& path : named->is_array() ? *named : Json::array({*named}))
        paths.push_back(path);
  if (paths.empty()) return ""; // through tables: draws have no unit
  return scene ? common_unit(paths, *scene) : std::nullopt;
}

bool drop_quantities(std::size_t before, std::vector<Problem>& problems) {
  constexpr std::string_view begin = "string \"", number = "+-.0123456789";
  const auto is_quantity = [&](const Problem& problem) {
    return problem.found.starts_with(begin) && problem.found.size() > begin.size() &&
           number.find(problem.found[begin.size()]) != std::string_view::npos;
  };
  const auto dropped = std::remove_if(problems.begin() + static_cast<std::ptrdiff_t>(before),
                                      problems.end(), is_quantity);
  const bool any = dropped != problems.end();
  problems.erase(dropped, problems.end());
  return any;
}

Distribution read_distribution(const JsonCursor& at, const std::filesystem::path& directory,
                               std::optional<std::string_view> known_unit) {
  const std::string_view unit = known_unit.value_or("");
  const std::size_t before = at.problems().size();
  Distribution distribution;
  constexpr std::string_view what = "a distribution: an object with its type";
  at.note(Question::What::object, what, "distribution");
  JsonObject object(at, what);
  std::size_t type = 0;
  if (!object.required_choice("type", type, type_names) || !object.is_object()) return distribution;
  distribution.law = default_law(type, every_law);
  std::visit(
      [&]<class L>(L& law) {
        if constexpr (std::is_same_v<L, Empirical>)
          read_empirical(object, law, directory, unit);
        else
          read_parameters(object, law, unit);
      },
      distribution.law);
  if (const auto truncate = object.find("truncate"))
    read_truncation(*truncate, distribution.truncate, unit);
  object.refuse_others();
  if (!known_unit && drop_quantities(before, at.problems())) return distribution;
  const std::vector<Problem> unread(at.problems().begin() + static_cast<std::ptrdiff_t>(before),
                                    at.problems().end());
  for (const DistributionFault& fault : faults(distribution))
    if (unread.empty() || is_of_itself(fault, distribution.law, at.pointer(), unread))
      at.refuse(fault.found, fault.expected, fault.path.empty() ? "" : "/" + fault.path);
  return distribution;
}

Json write_distribution(const Distribution& distribution) {
  Json json{{"type", type_of(distribution.law)}};
  std::visit(
      [&]<class L>(const L& law) {
        for (const auto& parameter : L::parameters())
          json[std::string(parameter.name)] = law.*parameter.member;
      },
      distribution.law);
  if (!distribution.truncate) return json;
  Json& truncate = json["truncate"] = Json::object();
  if (std::isfinite(distribution.truncate->lower)) truncate["lower"] = distribution.truncate->lower;
  if (std::isfinite(distribution.truncate->upper)) truncate["upper"] = distribution.truncate->upper;
  return json;
}

std::string_view type_of(const Law& law) { return type_names[law.index()]; }

} // namespace wingspread
