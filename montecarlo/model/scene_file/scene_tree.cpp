#include "montecarlo/model/scene_file/scene_tree.hpp"

#include "montecarlo/foundation/formats/nearest.hpp"
#include "montecarlo/foundation/formats/printable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>

namespace wingspread {
namespace {

constexpr std::string_view base_name = "base";

bool is_plain(std::string_view name) {
  return !name.empty() && name.find_first_of(".*/,\">") == std::string_view::npos &&
         !has_control_characters(name);
}

/// @param list "bodies", "hinges" or "synchronisations"
template <class Named>
void check_names_of(const JsonCursor& at, const char* list, const std::vector<Named>& all) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Json& spec = at.value()[list][i];
    if (!spec.is_object() || !spec.contains("name") || !spec["name"].is_string()) continue;
    const JsonCursor name = at.member(list).element(i).member("name");
    const auto same = [&](const Named& other) { return other.name == all[i].name; };
    const auto first = static_cast<std::size_t>(std::ranges::find_if(all, same) - all.begin());
    if (!is_plain(all[i].name))
      name.refuse("a name, not empty, without . * / , \" > and control characters");
    else if (first < i)
      name.refuse(fmt::format("string \"{}\", the name of /{}/{} too", all[i].name, list, first),
                  "a name of its own");
    else if (std::string_view(list) != "synchronisations" && all[i].name == base_name)
      name.refuse("another name: \"base\" is the base's"); // as are the outputs base.rate …
  }
}

/// The index of the body with this name; nothing if there is none.
std::optional<int> body_index(const Scene& scene, const std::string& name) {
  const auto same = [&](const Body& body) { return body.name == name; };
  const auto found = std::ranges::find_if(scene.bodies, same);
  if (found == scene.bodies.end()) return std::nullopt;
  return static_cast<int>(found - scene.bodies.begin());
}

std::vector<std::string> body_names(const Scene& scene, bool with_base) {
  std::vector<std::string> names;
  if (with_base) names.emplace_back(base_name);
  for (const Body& body : scene.bodies) names.push_back(body.name);
  return names;
}

bool distinct_names(const std::vector<Body>& bodies) {
  std::set<std::string_view> names;
  for (const Body& body : bodies) names.insert(body.name);
  return names.size() == bodies.size();
}

/// Sets both ends of a hinge; returns false, with a problem for each unknown name, if one is missing.
bool link(const JsonCursor& at, const HingeEnds& ends, const Scene& scene, Hinge& hinge) {
  if (!ends.parent || !ends.child) return false; // has a problem already
  const auto parent = *ends.parent == base_name ? base_index : body_index(scene, *ends.parent);
  const auto child = body_index(scene, *ends.child);
  if (!parent)
    at.member("parent").refuse("\"base\" or a body's name" +
                               did_you_mean(*ends.parent, body_names(scene, true)));
  if (!child)
    at.member("child").refuse("a body's name" +
                              did_you_mean(*ends.child, body_names(scene, false)));
  hinge.parent = parent.value_or(base_index);
  hinge.child = child.value_or(0);
  return parent && child;
}

/// Notes a problem for each body that is the child of several hinges or of none.
bool check_children(const JsonCursor& at, const Scene& scene) {
  std::vector<std::optional<std::size_t>> hinge_of(scene.bodies.size());
  bool sound = true;
  for (std::size_t h = 0; h < scene.hinges.size(); ++h) {
    auto& hinge = hinge_of[scene.hinges[h].child];
    const std::string& child = scene.bodies[scene.hinges[h].child].name;
    if (hinge)
      sound = at.member("hinges").element(h).member("child").refuse(
          fmt::format("string \"{}\", the child of hinge \"{}\" too", child,
                      scene.hinges[*hinge].name),
          "a body that is the child of no other hinge");
    hinge = hinge.value_or(h);
  }
  for (std::size_t b = 0; b < hinge_of.size(); ++b)
    if (!hinge_of[b])
      sound = at.member("bodies").element(b).refuse(
          fmt::format("\"{}\", the child of no hinge", scene.bodies[b].name),
          "a body that is the child of one hinge");
  return sound;
}

/// Notes a cycle of bodies, each the child of the next: "a < b < a".
/// @pre every body is the child of one hinge, and the hinges are no tree
void refuse_cycle(const JsonCursor& at, const Scene& scene) {
  const std::size_t n = scene.bodies.size();
  std::vector<std::size_t> hinge_of(n);
  for (std::size_t h = 0; h < n; ++h) hinge_of[scene.hinges[h].child] = h;
  const auto parent = [&](int body) { return scene.hinges[hinge_of[body]].parent; };
  const auto ancestor = [&](int body) { // n steps up: on a cycle, or the base
    for (std::size_t step = 0; step < n && body != base_index; ++step) body = parent(body);
    return body;
  };
  int on_cycle = base_index;
  for (int b = 0; on_cycle == base_index; ++b) on_cycle = ancestor(b);
  std::string cycle = scene.bodies[on_cycle].name;
  int body = on_cycle;
  do {
    body = parent(body);
    cycle += " < " + scene.bodies[body].name;
  } while (body != on_cycle);
  at.member("hinges")
      .element(hinge_of[on_cycle])
      .member("parent")
      .refuse("a cycle of parents: " + cycle, "hinges that form a tree rooted at base");
}

} // namespace

bool may_be_name(std::string_view name) { return is_plain(name) && name != base_name; }

void check_names(const JsonCursor& at, const Scene& scene) {
  check_names_of(at, "bodies", scene.bodies);
  check_names_of(at, "hinges", scene.hinges);
  check_names_of(at, "synchronisations", scene.synchronisations);
}

void link_hinges(const JsonCursor& at, const std::vector<HingeEnds>& ends, Scene& scene) {
  if (ends.empty() || scene.bodies.empty() || !distinct_names(scene.bodies)) return;
  bool linked = true;
  for (std::size_t h = 0; h < ends.size(); ++h)
    linked = link(at.member("hinges").element(h), ends[h], scene, scene.hinges[h]) && linked;
  if (linked && check_children(at, scene) && outward_order(scene).empty()) refuse_cycle(at, scene);
}

void link_releases(const JsonCursor& at, const std::vector<HingeEnds>& ends, Scene& scene) {
  for (std::size_t h = 0; h < ends.size(); ++h) {
    if (!ends[h].after) continue;
    const JsonCursor place = at.member("hinges").element(h).member("release").member("after");
    Release& release = *scene.hinges[h].release;
    const auto other = std::ranges::find(scene.hinges, *ends[h].after, &Hinge::name);
    if (other == scene.hinges.end()) {
      std::vector<std::string> names;
      for (const Hinge& hinge : scene.hinges) names.push_back(hinge.name);
      place.refuse("a hinge's name" + did_you_mean(*ends[h].after, names));
      continue;
    }
    release.after = static_cast<int>(other - scene.hinges.begin());
    if (release.after == static_cast<int>(h))
      place.refuse("another hinge than the one that is held");
    else if (release.event == Release::Event::latched && !other->latch)
      place.refuse("a hinge that has a latch, for the event \"latched\"");
    else if (release.event == Release::Event::released && !other->release)
      place.refuse("a hinge that has a release, for the event \"released\"");
    else if (release.event == Release::Event::passed && other->joint)
      place.refuse("a hinge that travels, for an angle: an elastic joint does not");
  }
}

} // namespace wingspread
