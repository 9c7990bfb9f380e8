#include "montecarlo/campaign/dispersion.hpp"

#include "distributions/random_stream.hpp"
#include "montecarlo/campaign/distribution_json.hpp"
#include "montecarlo/formats/output_name.hpp"
#include "montecarlo/formats/printable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace wingspread {
namespace {

constexpr std::array<std::string_view, 5> columns_of_runs{"run", "status", "latch_order", "reason",
                                                          "deployed"};

constexpr std::size_t most_dispersions = 10'000;

/// A dispersion of the campaign and where it was read.
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
         *parse_output_name(name).unit != '\0';
}

/// One copy of the dispersion for each match of `each`, named after the body or hinge.
std::vector<Dispersion> expand(const JsonCursor& each, const Scene* scene,
                               const Dispersion& pattern) {
  std::vector<Dispersion> expanded;
  for (const auto& [parameter, name] : read_path(each, scene)) {
    if (name.empty()) {
      each.refuse("the path of a body's or a hinge's parameter (\"to\" takes the base's)");
      continue;
    }
    expanded.push_back(pattern);
    expanded.back().name += "." + name;
    expanded.back().targets = {parameter};
  }
  return expanded;
}

/// The targets of a dispersion that is read but for them: itself, or its copies.
std::vector<Dispersion> read_targets(JsonObject& object, const Scene* scene,
                                     Dispersion dispersion) {
  const auto to = object.find("to"), each = object.find("each");
  if (object.is_object() && to.has_value() == each.has_value())
    object.at().refuse(to ? "both \"to\" and \"each\"" : "neither \"to\" nor \"each\"",
                       "one of them");
  else if (each)
    return expand(*each, scene, dispersion);
  else if (to)
    dispersion.targets = read_paths(*to, scene);
  return {std::move(dispersion)};
}

/// The unit of the draws that are set or added: that of all targets. Empty where they have none in common; paths that
/// lead nowhere are noted when the targets are read.
std::string_view unit_of_draws(const Json& spec, const Scene* scene) {
  if (!scene || !spec.is_object() || spec.value("apply", Json()) == "scale") return "";
  std::set<std::string_view> units;
  const auto take = [&](const Json& path) {
    if (!path.is_string()) return;
    for (const ParameterMatch& match : resolve(*scene, path.get<std::string>()).matches)
      units.insert(unit_of(match.parameter));
  };
  if (spec.contains("each")) take(spec["each"]);
  if (spec.contains("to") && spec["to"].is_array())
    for (const Json& path : spec["to"]) take(path);
  return units.size() == 1 ? *units.begin() : "";
}

std::vector<Dispersion> read_dispersion(const JsonCursor& at, const Scene* scene,
                                        const std::filesystem::path& directory, Json& resolved) {
  Dispersion dispersion;
  JsonObject object(at, "a dispersion: an object");
  object.required("name", dispersion.name,
                  "a string, not empty, without commas, quotes and control characters",
                  is_column_name);
  if (const auto law = object.require("distribution", "a distribution: an object with its type")) {
    dispersion.distribution = read_distribution(*law, directory, unit_of_draws(at.value(), scene));
    resolved["distribution"] = write_distribution(dispersion.distribution);
  }
  object.required_choice("apply", dispersion.apply, apply_names);
  auto read = read_targets(object, scene, std::move(dispersion));
  object.refuse_others();
  return read;
}

/// Notes each name that is another column's, or shares its random stream with another.
void check_names(const std::vector<Sourced>& all) {
  std::map<std::uint64_t, std::string> streams;
  for (const auto& [dispersion, at] : all) {
    const std::string& name = dispersion.name;
    if (name.empty()) continue; // noted when it was read
    const auto refuse = [&, &place = at](const std::string& found, std::string_view expected) {
      place.refuse(fmt::format("\"{}\", {}", name, found), expected, "/name");
    };
    const auto [same, is_new] = streams.emplace(stream_name(name).hash, name);
    if (is_taken(name))
      refuse("the name of a column of the results", "another name");
    else if (!is_new && same->second == name)
      refuse("the name of another dispersion too", "a name of its own");
    else if (!is_new)
      refuse(fmt::format("whose random stream is that of \"{}\" too", same->second),
             "another name");
  }
}

/// Notes each dispersion that sets a parameter which one before it has written.
void check_order(const std::vector<Sourced>& all, const Scene& scene) {
  std::map<SceneParameter, std::string> writers;
  for (const auto& [dispersion, at] : all)
    for (const SceneParameter& target : dispersion.targets) {
      const auto [writer, first] = writers.emplace(target, dispersion.name);
      if (!first && dispersion.apply == Apply::set)
        at.refuse(fmt::format("\"set\" of {}, which \"{}\" has written before",
                              path_of(scene, target), writer->second),
                  "nothing before a \"set\", which would undo it", "/apply");
    }
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

} // namespace wingspread
