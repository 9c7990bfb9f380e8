#include "core/deployment.hpp"

#include "core/integrator.hpp"

#include <algorithm>
#include <utility>

namespace wingspread {

const char* to_string(Status status) {
  switch (status) {
  case Status::deployed:
    return "deployed";
  case Status::stalled:
    return "stalled";
  case Status::timed_out:
    return "timed_out";
  case Status::invalid:
    return "invalid";
  case Status::failed:
    return "failed";
  }
  return "unknown";
}

const std::vector<MethodInfo>& methods() {
  static const std::vector<MethodInfo> list{
      {"auto", "chooses by itself", 0, 0, 0, "that of the method chosen",
       "the default; in this version always dopri5"},
      {"dopri5", "explicit Runge-Kutta, adaptive", 5, 3.307, 0.997,
       "quintic Hermite on angle, rate and acceleration; order 5",
       "Dormand and Prince 5(4), first same as last"},
  };
  return list;
}

std::string methods_used(const Outcome& outcome) {
  std::vector<std::string> names;
  std::string text;
  for (const Phase& phase : outcome.phases) {
    if (std::find(names.begin(), names.end(), phase.method) != names.end()) continue;
    names.push_back(phase.method);
    text += (text.empty() ? "" : ", ") + phase.method;
  }
  return text;
}

struct Deployment::Workspace {
  std::vector<std::pair<int, int>> tree; ///< (parent, child) of every hinge of the scene before
  Wing<double> wing;
  wingspread::Workspace<double> scratch;
};

Deployment::Deployment() : workspace_(std::make_unique<Workspace>()) {}
Deployment::~Deployment() = default;
Deployment::Deployment(Deployment&&) noexcept = default;
Deployment& Deployment::operator=(Deployment&&) noexcept = default;

namespace {

template <BaseMotion M, class Topology>
Outcome integrate(const Wing<double>& wing, const Topology& topology, Workspace<double>& scratch,
                  const Integration& how, const Goal& goal, const Observer& observer) {
  System<double, Topology, M> system(wing, topology, how.smoothing, scratch);
  return Integrator<double, Topology, M, DormandPrince5<double>>(system, how, goal, observer).run();
}

/// On a fixed base: the chain of a length known to the compiler, if it has one.
template <int N = 1>
Outcome integrate_chain(const Wing<double>& wing, Workspace<double>& scratch,
                        const Integration& how, const Goal& goal, const Observer& observer) {
  if constexpr (N <= longest_static_chain) {
    if (wing.size() == N)
      return integrate<BaseMotion::fixed>(wing, Chain<N>{}, scratch, how, goal, observer);
    return integrate_chain<N + 1>(wing, scratch, how, goal, observer);
  } else {
    return integrate<BaseMotion::fixed>(wing, wing.tree, scratch, how, goal, observer);
  }
}

Outcome integrate(const Wing<double>& wing, Workspace<double>& scratch, const Integration& how,
                  const Goal& goal, const Observer& observer) {
  switch (wing.base.motion) {
  case BaseMotion::prescribed:
    return integrate<BaseMotion::prescribed>(wing, wing.tree, scratch, how, goal, observer);
  case BaseMotion::free:
    return integrate<BaseMotion::free>(wing, wing.tree, scratch, how, goal, observer);
  case BaseMotion::fixed:
    break;
  }
  if (!is_chain(wing.tree))
    return integrate<BaseMotion::fixed>(wing, wing.tree, scratch, how, goal, observer);
  return integrate_chain(wing, scratch, how, goal, observer);
}

[[nodiscard]] const Hinge* with_exact_friction(const Scene& scene) {
  for (const Hinge& hinge : scene.hinges)
    if (hinge.friction.model == FrictionModel::exact) return &hinge;
  return nullptr;
}

[[nodiscard]] Outcome invalid(const std::vector<Fault>& faults) {
  Outcome out;
  out.status = Status::invalid;
  for (const Fault& fault : faults) {
    if (!out.reason.empty()) out.reason += "; ";
    out.reason += fault.path + " is " + fault.found + ", expected " + fault.expected;
  }
  return out;
}

} // namespace

Outcome Deployment::run(const Scene& scene, const Integration& integration, const Goal& goal,
                        const Observer& observer) {
  if (const std::vector<Fault> faults = unphysical(scene); !faults.empty()) return invalid(faults);
  if (const Hinge* exact = with_exact_friction(scene)) {
    const std::string path = std::string("hinges.").append(exact->name).append(".friction.model");
    return invalid(
        {{path, "exact", "regularized (exact friction is not available in this version)"}});
  }
  std::vector<std::pair<int, int>> tree(scene.hinges.size());
  std::transform(scene.hinges.begin(), scene.hinges.end(), tree.begin(),
                 [](const Hinge& hinge) { return std::pair(hinge.parent, hinge.child); });
  if (tree != workspace_->tree) {
    workspace_->wing = make_wing<double>(scene, outward_order(scene));
    workspace_->tree = std::move(tree);
  }
  set_parameters(workspace_->wing, scene);
  Outcome out = integrate(workspace_->wing, workspace_->scratch, integration, goal, observer);
  out.phases = {{"dopri5", 0, out.t_end, out.work.steps}};
  return out;
}

} // namespace wingspread
