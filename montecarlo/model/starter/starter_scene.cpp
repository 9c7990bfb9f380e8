#include "montecarlo/model/starter/starter_scene.hpp"

#include "core/deployment.hpp"
#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/formats/json_parse.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace wingspread {
namespace {

// Heuristics, in proportion to the springs, so that small and large wings behave alike. They are starting values: the
// notes ask for the project's own. With loops ten times softer the hinges would no longer latch within degrees of each
// other; latches ten times stiffer cost more time than they change peaks.
constexpr double latched_share = 0.65;       // of a spring's torque
constexpr double stowed_harness_share = 0.1; // of the largest torque of the cables
constexpr double static_share = 1.5;         // of the Coulomb level
constexpr double latch_per_spring = 5000;    // 1/rad
constexpr double latch_damping_ratio =
    0.05;                               // far below the half at which the damper alone makes a peak
constexpr double loop_per_spring = 150; // 1/rad
constexpr double loop_damping = 0.01;   // s
constexpr double preload_per_spring = 5;
constexpr double stop_per_spring = 2000; // 1/rad
constexpr double drag_coefficient = 2;   // of a long flat plate across the flow

using Elements = std::vector<AnnotatedLines>;

double largest_spring(const WingDesign& design) {
  return has_other_hinges(design) ? std::max(design.root_spring, design.spring)
                                  : design.root_spring;
}

double spring_of(const WingDesign& design, bool root) {
  return root ? design.root_spring : design.spring;
}

std::string point(const Eigen::Vector2d& at) {
  return fmt::format("[{}, {}]", short_number(at.x()), short_number(at.y()));
}

AnnotatedLines body_lines(const DesignedBody& body, bool explained) {
  const std::string half = short_number(body.length / 2);
  AnnotatedLines lines{
      {fmt::format(R"(    {{ "name": "{}", "mass": {}, "inertia": {},)", body.name,
                   short_number(body.mass), short_number(rounded(body.inertia(), 4))),
       "a rigid body: its mass in kg, and its inertia about its centre of mass in kg·m², here of "
       "a uniform plate, mass × length²/12"},
      {fmt::format(R"(      "plate": {{ "from": [-{0}, 0], "to": [{0}, 0], "width": {1}, )"
                   R"("drag_coefficient": {2} }} }})",
                   half, short_number(body.width), drag_coefficient),
       "the outline from its centre of mass, in m: it is drawn, checked for bodies that overlap, "
       "and feels air in a ground test"}};
  if (!explained)
    for (AnnotatedLine& line : lines) line.note.clear();
  return lines;
}

/// Inertia of all bodies from the hinge on, about the hinge, with the wing deployed.
double inertia_beyond(const DesignedWing& wing, std::size_t hinge) {
  double inertia = 0, inner = 0;
  for (std::size_t b = hinge; b < wing.bodies.size(); ++b) {
    const DesignedBody& body = wing.bodies[b];
    const double distance = inner + body.length / 2;
    inertia += body.inertia() + body.mass * distance * distance;
    inner += body.length;
  }
  return inertia;
}

std::string latch_text(const WingDesign& design, const DesignedWing& wing, std::size_t h) {
  const double stiffness = two_digits(latch_per_spring * largest_spring(design));
  const double damping =
      two_digits(2 * latch_damping_ratio * std::sqrt(stiffness * inertia_beyond(wing, h)));
  return fmt::format(R"(      "latch": {{ "stiffness": {}, "damping": {} }} }})",
                     short_number(stiffness), short_number(damping));
}

AnnotatedLines torque_lines(const WingDesign& design, bool root) {
  const double spring = spring_of(design, root);
  AnnotatedLines lines{
      {fmt::format(R"(      "spring": {{ "torque_stowed": {}, "torque_latched": {} }},)",
                   short_number(spring), short_number(two_digits(latched_share * spring))),
       "positive deploys, in N·m, linear in between; a torque test goes in as \"measured\" or as "
       "\"table\" (units: \"12 in*lbf\")"}};
  if (design.harness > 0)
    lines.push_back(
        {fmt::format(R"(      "harness": {{ "torque_stowed": {}, "torque_latched": {} }},)",
                     short_number(two_digits(stowed_harness_share * design.harness)),
                     short_number(design.harness)),
         "cables across the hinge: positive resists; measure them cold"});
  if (design.friction > 0)
    lines.push_back(
        {fmt::format(R"(      "friction": {{ "model": "exact", "coulomb": {}, "static": {} }},)",
                     short_number(design.friction), short_number(static_share * design.friction)),
         "friction in N·m, sliding and at rest: a hinge whose load is less stays where it is"});
  if (root && design.damper.value_or(0) > 0)
    lines.push_back(
        {fmt::format(R"(      "damper": {{ "law": "viscous", "coefficient": {} }},)",
                     short_number(*design.damper)),
         design.damper_suggested
             ? "a rotary damper, N·m·s/rad, here chosen so that the wing takes about twice the time"
             : "a rotary damper, N·m·s/rad"});
  return lines;
}

AnnotatedLines hinge_lines(const WingDesign& design, const DesignedWing& wing, std::size_t h) {
  const DesignedHinge& hinge = wing.hinges[h];
  AnnotatedLines lines{
      {fmt::format(R"(    {{ "name": "{}", "parent": "{}", "child": "{}",)", hinge.name,
                   hinge.parent, hinge.child),
       "the hinge that carries its child on its parent"},
      {fmt::format(R"(      "parent_point": {}, "child_point": {},)", point(hinge.parent_point),
                   point(hinge.child_point)),
       h == 0 ? "where the hinge is, in m: on the spacecraft's wall, and from the child's centre "
                "of mass, on the face that lies on the wall when stowed"
              : "where the hinge is, in m: from the parent's and from the child's centre of mass, "
                "on the face on which the child folds; the faces alternate, so that the stack is "
                "flat and the wing straight"},
      {fmt::format(R"(      "angle": {{ "stowed": "{} deg", "latched": 0 }},)", hinge.stowed),
       "of the child relative to its parent: it starts at `stowed`, and latches at `latched`"}};
  for (AnnotatedLine& line : torque_lines(design, h == 0)) lines.push_back(std::move(line));
  lines.push_back(
      {fmt::format(R"(      "stop": {{ "stiffness": {}, "dissipation": 0.3 }},)",
                   short_number(two_digits(stop_per_spring * spring_of(design, h == 0)))),
       "the panel rests against the stack at the stowed angle and cannot turn through it"});
  lines.push_back({latch_text(design, wing, h),
                   "once engaged, a spring and a damper about the latched angle, N·m/rad and "
                   "N·m·s/rad; the stiffness is that of the joint, as a modal test finds it"});
  return lines;
}

AnnotatedLines explained_hinges(const WingDesign& design, const std::vector<DesignedWing>& wings) {
  Elements elements;
  for (const DesignedWing& wing : wings)
    for (std::size_t h = 0; h < wing.hinges.size(); ++h) {
      AnnotatedLines lines = hinge_lines(design, wing, h);
      const bool first_wing = &wing == &wings.front();
      for (std::size_t i = 0; i < lines.size(); ++i)
        if (!first_wing || h > 1 || (h == 1 && i != 1)) lines[i].note.clear();
      elements.push_back(std::move(lines));
    }
  return joined(std::move(elements));
}

AnnotatedLines loops(const WingDesign& design, const std::vector<DesignedWing>& wings) {
  const double stiffness = two_digits(loop_per_spring * largest_spring(design));
  Elements elements;
  for (const DesignedWing& wing : wings)
    for (std::size_t h = 1; h < wing.hinges.size(); ++h) {
      const std::string &first = wing.hinges[h - 1].name, &second = wing.hinges[h].name;
      elements.push_back(
          {{fmt::format(R"(    {{ "name": "{}_loop", "between": ["{}", "{}"], "ratio": {},)",
                        second, first, second, h == 1 ? 2 : 1),
            "a closed cable loop turns both hinges together: 180° of one for 90° of the root"},
           {fmt::format(R"(      "stiffness": {}, "damping": {}, "preload": {} }})",
                        short_number(stiffness), short_number(two_digits(loop_damping * stiffness)),
                        short_number(two_digits(preload_per_spring * largest_spring(design)))),
            "of the loop, N·m/rad and N·m·s/rad; the preload, N·m, is the strands' tension times "
            "the pulley's radius"}});
      if (elements.size() > 1)
        for (AnnotatedLine& line : elements.back()) line.note.clear();
    }
  return joined(std::move(elements));
}

/// When the last latch of the nominal wing engages, s; infinite if it does not deploy by t_end.
double deployment_time(const WingDesign& design, double t_end) {
  Goal goal;
  goal.peak_moment = goal.peak_force = goal.audit = false;
  Integration integration;
  integration.t_end = t_end;
  const Outcome outcome = Deployment().run(scene_of(design), integration, goal);
  return outcome.status == Status::deployed ? outcome.latches.back().time
                                            : std::numeric_limits<double>::infinity();
}

/// The mean torque of all hinges of one wing, referred to its root by the loops, N·m.
double mean_torque(const WingDesign& design) {
  double torque = 0;
  const auto hinges = designed_wing(design, false).hinges.size();
  for (std::size_t h = 0; h < hinges; ++h) {
    const double spring = 0.5 * (1 + latched_share) * spring_of(design, h == 0);
    const double cables = 0.5 * (1 + stowed_harness_share) * design.harness;
    torque += (h == 0 ? 1 : 2) * (spring - cables - design.friction);
  }
  return torque;
}

void append(AnnotatedLines& lines, AnnotatedLines more) {
  for (AnnotatedLine& line : more) lines.push_back(std::move(line));
}

} // namespace

double two_digits(double value) { return rounded(value, 2); }

AnnotatedLines starter_scene(const WingDesign& design) {
  const std::vector<DesignedWing> wings = designed_wings(design);
  AnnotatedLines lines{
      {"{"},
      {fmt::format(R"(  "name": "{}",)", design.name), "heads every table and the report"},
      {R"(  "base": { "motion": "fixed" },)",
       "the spacecraft, held still; a free one moves, and needs its mass and inertia"},
      {R"(  "bodies": [)"}};
  Elements bodies;
  for (const DesignedWing& wing : wings)
    for (const DesignedBody& body : wing.bodies) bodies.push_back(body_lines(body, bodies.empty()));
  append(lines, joined(std::move(bodies)));
  append(lines, {{"  ],"}, {R"(  "hinges": [)"}});
  append(lines, explained_hinges(design, wings));
  if (wings.front().hinges.size() > 1) {
    append(lines, {{"  ],"}, {R"(  "synchronisations": [)"}});
    append(lines, loops(design, wings));
  }
  append(lines, {{"  ]"}, {"}"}});
  return lines;
}

Scene scene_of(const WingDesign& design) {
  return read_scene(parse_json(json_file_text(starter_scene(design))));
}

double suggested_damper(WingDesign design) {
  constexpr double wanted = 2, close = 0.05, tolerance = 0.1; // of the ratio of both times
  constexpr double longest = 4;                               // times the time without a damper
  constexpr int most_trials = 12; // heuristic: usual wings take two to four
  design.damper = 0;
  const double alone = deployment_time(design, latest_end);
  if (std::isinf(alone)) return 0;
  struct Trial {
    double damper, ratio;
    [[nodiscard]] double off() const { return std::abs(ratio - wanted); }
  };
  Trial below{0, 1}, best = below;
  std::optional<Trial> above;
  // The damper that takes the mean torque at the root's mean rate slows a wing to 1.4 to 1.8 times.
  double next = two_digits(mean_torque(design) * alone / (std::numbers::pi / 2));
  for (int k = 0; k < most_trials && best.off() > close; ++k) {
    design.damper = next;
    const Trial trial{next, deployment_time(design, longest * alone) / alone};
    if (trial.off() < best.off()) best = trial;
    if (trial.ratio > wanted)
      above = trial;
    else
      below = trial;
    const Trial from = above ? below : Trial{0, 1}, to = above ? *above : below;
    next = std::isinf(to.ratio) ? 0.5 * (from.damper + to.damper)
           : to.ratio <= 1
               ? 2 * next
               : std::lerp(from.damper, to.damper, (wanted - from.ratio) / (to.ratio - from.ratio));
    next = two_digits(next);
    if (next == below.damper || (above && next == above->damper)) break;
  }
  return best.off() <= tolerance * wanted ? best.damper : 0;
}

} // namespace wingspread
