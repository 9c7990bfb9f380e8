#include "montecarlo/model/campaign/cases.hpp"

#include "montecarlo/foundation/formats/nearest.hpp"
#include "montecarlo/model/campaign/distribution_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace wingspread {
namespace {

constexpr const char* name_expected =
    "a string, the name of a folder: letters, digits, \"_\" and \"-\"";

class CaseReader {
public:
  CaseReader(const Scene* scene, const Dispersions* dispersions, std::filesystem::path directory)
      : scene_(scene), dispersions_(dispersions), directory_(std::move(directory)) {
    if (dispersions) set_by_draws_ = set_by_draws(dispersions->list);
  }

  [[nodiscard]] CaseSpec read(const JsonCursor& at) {
    CaseSpec spec;
    JsonObject object(at, "a case: an object");
    const std::size_t before = at.problems().size();
    object.required("name", spec.name, name_expected, is_case_name);
    spec.resolved = {{"name", spec.name}};
    for (std::size_t how = 0; how < apply_names.size(); ++how)
      if (const auto changes = object.find(apply_names[how]))
        read_changes(*changes, static_cast<Apply>(how), spec);
    if (const auto laws = object.find("distributions")) read_laws(*laws, spec);
    object.refuse_others();
    if (scene_ && at.problems().size() == before) refuse_unphysical_case(at, spec);
    return spec;
  }

private:
  void read_changes(const JsonCursor& at, Apply how, CaseSpec& spec) {
    if (!at.value().is_object())
      return void(at.refuse("an object with numbers by the paths of parameters"));
    const std::string key(apply_names[static_cast<std::size_t>(how)]);
    for (const auto& [path, value] : at.value().items()) {
      const auto first = std::ssize(spec.changes);
      const JsonCursor place = at.member(path);
      if (!scene_) continue;
      read_change(place, path, how, *scene_, spec.changes);
      if (std::ssize(spec.changes) > first)
        spec.resolved[key][path] = spec.changes[static_cast<std::size_t>(first)].value;
      refuse_lost(place, std::span(spec.changes).subspan(static_cast<std::size_t>(first)));
    }
  }

  /// Refuses changes that a dispersion would overwrite.
  void refuse_lost(const JsonCursor& at, std::span<const CaseChange> changes) const {
    for (const CaseChange& change : changes)
      if (const auto found = set_by_draws_.find(change.target); found != set_by_draws_.end())
        at.refuse(fmt::format("a change of {}, which \"{}\" sets in every run",
                              path_of(*scene_, change.target), found->second),
                  "a parameter that no dispersion sets (\"distributions\" gives that one another "
                  "law in a case)");
  }

  void read_laws(const JsonCursor& at, CaseSpec& spec) const {
    if (!at.value().is_object())
      return void(at.refuse("an object with distributions by the names of dispersions"));
    for (const auto& [name, law] : at.value().items()) {
      const JsonCursor place = at.member(name);
      const Json* listed = find_dispersion(name);
      if (dispersions_ && !listed)
        place.refuse(fmt::format("\"{}\"", name),
                     "the name of a dispersion" + did_you_mean(name, dispersion_names()));
      if (listed && listed->contains("rows"))
        place.refuse(fmt::format("\"{}\", which draws rows", name),
                     "the name of a dispersion with a distribution");
      spec.distributions.push_back(
          {name, read_distribution(place, directory_,
                                   listed ? unit_of_draws(*listed, scene_) : std::nullopt)});
    }
  }

  [[nodiscard]] const Json* find_dispersion(const std::string& name) const {
    if (!dispersions_) return nullptr;
    for (const Json& listed : dispersions_->resolved)
      if (listed.is_object() && listed.value("name", Json()) == name) return &listed;
    return nullptr;
  }

  [[nodiscard]] std::vector<std::string> dispersion_names() const {
    std::vector<std::string> names;
    for (const Json& listed : dispersions_->resolved)
      names.push_back(listed.at("name").get<std::string>());
    return names;
  }

  void refuse_unphysical_case(const JsonCursor& at, const CaseSpec& spec) const {
    const Json set = at.value().is_object() ? at.value().value("set", Json::object()) : Json();
    for (const Fault& fault : unphysical(scene_of_case(*scene_, spec)))
      at.refuse(fmt::format("{} of {}", fault.path,
                            set.contains(fault.path) ? as_written(set[fault.path]) : fault.found),
                fmt::format("{}, in the case too", fault.expected));
  }

  const Scene* scene_;
  const Dispersions* dispersions_;
  std::filesystem::path directory_;
  std::map<SceneParameter, std::string> set_by_draws_;
};

} // namespace

bool is_case_name(const std::string& name) {
  constexpr std::string_view allowed =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  return !name.empty() && name.front() != '-' && name.size() <= 100 &&
         name.find_first_not_of(allowed) == std::string::npos;
}

std::vector<CaseSpec> read_cases(const JsonCursor& at, const Scene* scene,
                                 const Dispersions* dispersions,
                                 const std::filesystem::path& directory) {
  if (!at.value().is_array()) at.refuse("an array of cases");
  CaseReader reader(scene, dispersions, directory);
  std::vector<CaseSpec> cases;
  for (const JsonCursor& element : at.elements()) {
    CaseSpec spec = reader.read(element);
    if (!spec.name.empty() && std::ranges::find(cases, spec.name, &CaseSpec::name) != cases.end())
      element.refuse(fmt::format("\"{}\", the name of another case too", spec.name),
                     "a name of its own", "/name");
    cases.push_back(std::move(spec));
  }
  return cases;
}

Json write_cases(std::span<const CaseSpec> cases) {
  Json list = Json::array();
  for (const CaseSpec& spec : cases) {
    list.push_back(spec.resolved);
    for (const auto& [dispersion, distribution] : spec.distributions)
      list.back()["distributions"][dispersion] = write_distribution(distribution);
  }
  return list;
}

void read_change(const JsonCursor& value, std::string_view path, Apply apply, const Scene& scene,
                 std::vector<CaseChange>& changes) {
  const ParameterMatches found = resolve(scene, path);
  if (found.matches.empty())
    return void(value.refuse(fmt::format("the path \"{}\"", path), found.expected));
  CaseChange change{apply, {}, 0};
  const std::string_view unit =
      apply == Apply::scale ? "" : common_unit(Json(path), scene).value_or("");
  if (apply != Apply::scale) value.note_quantity("in the parameter's unit");
  if (!value.read(change.value, Dimension{unit})) return;
  for (const ParameterMatch& match : found.matches) {
    change.target = match.parameter;
    const auto is_same = [&](const CaseChange& other) {
      return other.apply == apply && other.target == change.target;
    };
    if (std::ranges::any_of(changes, is_same))
      value.refuse_repeated(path_of(scene, change.target), "each parameter once");
    changes.push_back(change);
  }
}

void make_changes(std::span<const CaseChange> changes, Scene& scene) {
  for (const auto& [apply, target, value] : changes) apply_to(target.in(scene), apply, value);
}

Scene scene_of_case(Scene nominal, const CaseSpec& spec) {
  make_changes(spec.changes, nominal);
  return nominal;
}

} // namespace wingspread
