#include "montecarlo/model/scene_file/mirror.hpp"

#include "montecarlo/model/scene_file/scene_tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace wingspread {
namespace {

constexpr std::string_view expected_pattern = "a name with one \"*\", as \"R_*\"";

bool is_pattern(const std::string& text) { return std::ranges::count(text, '*') == 1; }

// From 0, so that 0 stays 0 and does not become −0.
void mirror(Eigen::Vector2d& point) { point.x() = 0 - point.x(); }
void mirror(double& angle) { angle = 0 - angle; }

/// The table with angles of the other sign, which keeps the columns' order from stowed to latched.
void mirror(std::shared_ptr<const TorqueTable>& table) {
  if (!table) return;
  std::vector<double> angle = table->angle();
  for (double& phi : angle) mirror(phi);
  table = std::make_shared<const TorqueTable>(
      table->both_ways()
          ? TorqueTable(std::move(angle), table->deploying(), table->stowing(),
                        table->interpolation())
          : TorqueTable(std::move(angle), table->deploying(), table->interpolation()));
}

Body mirrored(Body body) {
  if (body.plate) mirror(body.plate->from), mirror(body.plate->to);
  return body;
}

Hinge mirrored(Hinge hinge) {
  mirror(hinge.parent_point), mirror(hinge.child_point);
  mirror(hinge.stowed), mirror(hinge.latched), mirror(hinge.initial_rate);
  mirror(hinge.spring.table), mirror(hinge.harness.table);
  if (hinge.damper && hinge.damper->window)
    for (double& angle : *hinge.damper->window) mirror(angle);
  return hinge;
}

/// Makes the copies, and keeps which index became which.
class Mirror {
public:
  Mirror(const JsonCursor& at, const MirrorNames& names, Scene& scene)
      : at_(at), names_(names), scene_(scene), body_(scene.bodies.size(), -1),
        hinge_(scene.hinges.size(), -1) {}

  void add() {
    if (!is_whole()) return;
    copy_all(scene_.bodies, body_, [](const Body& body) { return mirrored(body); });
    copy_all(scene_.hinges, hinge_, [&](const Hinge& hinge) {
      Hinge copy = mirrored(hinge);
      copy.child = body_[hinge.child];
      if (hinge.parent != base_index) copy.parent = body_[hinge.parent];
      if (hinge.release && hinge.release->after >= 0 && hinge_[hinge.release->after] >= 0)
        copy.release->after = hinge_[hinge.release->after];
      return copy;
    });
    std::vector<int> loops(scene_.synchronisations.size(), -1);
    copy_all(scene_.synchronisations, loops, [&](Synchronisation loop) {
      loop.first = hinge_[loop.first], loop.second = hinge_[loop.second];
      return loop;
    });
  }

private:
  /// Whether the names cover whole wings, each hung on the base, with their loops.
  [[nodiscard]] bool is_whole() const {
    bool whole = true, any = false;
    for (const Hinge& hinge : scene_.hinges) {
      const std::string& child = scene_.bodies[hinge.child].name;
      const bool covered = names_.covers(hinge.name);
      any = any || covered;
      if (covered != names_.covers(child))
        whole = refuse(fmt::format("hinge \"{}\" and its child \"{}\"", hinge.name, child),
                       "a pattern that covers both or neither");
      else if (covered && hinge.parent != base_index &&
               !names_.covers(scene_.bodies[hinge.parent].name))
        whole = refuse(fmt::format("hinge \"{}\", whose parent \"{}\" has no copy", hinge.name,
                                   scene_.bodies[hinge.parent].name),
                       "hinges whose parents are covered or the base");
    }
    for (const Synchronisation& loop : scene_.synchronisations) {
      const bool first = names_.covers(scene_.hinges[loop.first].name);
      const bool second = names_.covers(scene_.hinges[loop.second].name);
      if (names_.covers(loop.name) ? !(first && second) : first && second)
        whole =
            refuse(fmt::format("synchronisation \"{}\"", loop.name),
                   "a pattern that covers a synchronisation if and only if it covers its hinges");
    }
    if (!any)
      return refuse(fmt::format("\"{}\", the name of no hinge", names_.of), expected_pattern);
    return whole && names_are_free();
  }

  [[nodiscard]] bool names_are_free() const {
    bool free = true;
    const auto check = [&](const auto& all) {
      for (const auto& owner : all) {
        if (!names_.covers(owner.name)) continue;
        const std::string copy = names_.copy_of(owner.name);
        if (!may_be_name(copy))
          free = at_.member("as").refuse(fmt::format("\"{}\", which makes \"{}\"", names_.as, copy),
                                         "a pattern whose copies have no . * / , \" > and control "
                                         "characters, and are not \"base\"");
        if (std::ranges::any_of(all, [&](const auto& other) { return other.name == copy; }))
          free = at_.member("as").refuse(
              fmt::format("\"{}\", which makes a second \"{}\"", names_.as, copy),
              "a pattern for names that the scene does not have");
      }
    };
    check(scene_.bodies), check(scene_.hinges), check(scene_.synchronisations);
    return free;
  }

  bool refuse(const std::string& found, std::string_view expected) const {
    return at_.member("of").refuse(found, expected);
  }

  template <class Named, class Copy>
  void copy_all(std::vector<Named>& all, std::vector<int>& copy_of, const Copy& copy) {
    const std::size_t given = all.size();
    for (std::size_t i = 0; i < given; ++i)
      if (names_.covers(all[i].name)) copy_of[i] = static_cast<int>(all.size() + made_++);
    made_ = 0;
    for (std::size_t i = 0; i < given; ++i) {
      if (copy_of[i] < 0) continue;
      Named made = copy(all[i]);
      made.name = names_.copy_of(all[i].name);
      all.push_back(std::move(made));
    }
  }

  const JsonCursor& at_;
  const MirrorNames& names_;
  Scene& scene_;
  std::vector<int> body_, hinge_; ///< index of the copy; −1: none
  std::size_t made_ = 0;
};

} // namespace

bool MirrorNames::covers(std::string_view name) const {
  const std::size_t star = of.find('*');
  const std::string_view head = std::string_view(of).substr(0, star),
                         tail = std::string_view(of).substr(star + 1);
  return name.size() >= head.size() + tail.size() && name.starts_with(head) && name.ends_with(tail);
}

std::string MirrorNames::copy_of(std::string_view name) const {
  const std::size_t head = of.find('*'), tail = of.size() - head - 1, star = as.find('*');
  return as.substr(0, star) + std::string(name.substr(head, name.size() - head - tail)) +
         as.substr(star + 1);
}

MirrorNames read_mirror(const JsonCursor& at) {
  MirrorNames names;
  JsonObject object(at, "an object with the patterns of and as");
  const bool of = object.required("of", names.of, expected_pattern, is_pattern);
  const bool as = object.required("as", names.as, expected_pattern, is_pattern);
  object.refuse_others();
  return of && as && object.is_object() ? names : MirrorNames{};
}

void explain_copies(const MirrorNames& names, const Scene& scene, std::size_t first,
                    std::vector<Problem>& problems) {
  if (names.as.empty()) return;
  const MirrorNames back{names.as, names.of};
  const auto is_in = [](const auto& all, const std::string& name) {
    return std::ranges::any_of(all, [&](const auto& each) { return each.name == name; });
  };
  for (std::size_t k = first; k < problems.size(); ++k) {
    const std::string& found = problems[k].found;
    const std::size_t quote = found.find('"'); // of: string "L_root"
    if (quote == std::string::npos || !found.ends_with('"')) continue;
    const std::string name = found.substr(quote + 1, found.size() - quote - 2);
    if (!back.covers(name)) continue;
    const std::string original = back.copy_of(name);
    if (!is_in(scene.hinges, original) && !is_in(scene.bodies, original)) continue;
    problems[k].expected =
        fmt::format("a name that the scene gives: \"mirror\" makes \"{}\" of \"{}\", and no hinge, "
                    "body or loop can name a copy. Write the second wing out to do so",
                    name, original);
  }
}

void add_mirrored(const JsonCursor& at, const MirrorNames& names, Scene& scene) {
  if (!names.of.empty()) Mirror(at, names, scene).add();
}

} // namespace wingspread
