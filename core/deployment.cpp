#include "core/deployment.hpp"

#include "core/methods/dop853.hpp"
#include "core/methods/method_choice.hpp"
#include "core/packs/runs.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace wingspread {

const std::vector<MethodInfo>& methods() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  static const std::string quintic = "quintic Hermite on angle, rate and acceleration, order 5; "
                                     "events and peaks then by a step of "
                                     "the method";
  static const std::string quintic_of_long_steps =
      quintic + "; steps limited to about a quarter of what oscillates";
  static const std::vector<MethodInfo> list{
      {"auto", "chooses by itself", 0, 0, 0, "that of the method active",
       "the default: dopri5 or, below rtol 5e-3 (5e-4 with smoothed latches), dop853, or, below "
       "5e-9 where there are series, taylor, "
       "until stability holds its steps back, then seulex where that gets further; the outcome's "
       "phases say what was used"},
      {"runge_kutta4", "explicit Runge-Kutta, fixed step", 4, RungeKutta4<double>::stable_real,
       RungeKutta4<double>::stable_imaginary, quintic,
       "takes the step given; fails where it misses the tolerance, by comparison with one of twice "
       "the size"},
      {"cash_karp54", "explicit Runge-Kutta, adaptive", 5, CashKarp54<double>::stable_real,
       CashKarp54<double>::stable_imaginary, quintic,
       "Cash and Karp 5(4); on the imaginary axis it grows at any step, by 1.4e-4 |hλ|⁶"},
      {"dopri5", "explicit Runge-Kutta, adaptive", 5, DormandPrince5<double>::stable_real,
       DormandPrince5<double>::stable_imaginary, quintic,
       "Dormand and Prince 5(4), first same as last"},
      {"fehlberg78", "explicit Runge-Kutta, adaptive", 8, Fehlberg78<double>::stable_real,
       Fehlberg78<double>::stable_imaginary, quintic_of_long_steps,
       "Fehlberg 8(7); its estimate sees a step's ends alone, so that a friction that changes sign "
       "inside may pass unnoticed: prefer dop853"},
      {"dop853", "explicit Runge-Kutta, adaptive", 8, DormandPrince853<double>::stable_real,
       DormandPrince853<double>::stable_imaginary, quintic_of_long_steps,
       "Dormand and Prince 8(5,3), for tight tolerances"},
      {"bulirsch_stoer", "explicit extrapolation, adaptive order and step", 0, 0, 0,
       quintic_of_long_steps,
       "modified midpoint rule, orders 4 to 16; stable on the real axis up to 4.457 at order 4, "
       "5.995 at order 10"},
      {"adams_bashforth_moulton", "explicit multistep, adaptive order and step", 0, 0, 0,
       quintic_of_long_steps,
       "orders 1 to 8, predict-evaluate-correct-evaluate; at equal steps stable up to 1.4 on the "
       "real axis, 0.5 on the imaginary"},
      {"rosenbrock_w", "linearly implicit Rosenbrock-W, adaptive", 3, infinity, infinity, quintic,
       "ROS34PW2 3(2), L-stable; the solve is the recursion with each hinge's inertia raised"},
      {"seulex", "linearly implicit extrapolation, adaptive order and step", 0, infinity, 0,
       quintic_of_long_steps,
       "linearly implicit Euler with n = 2, 3, 4, … substeps, orders 3 to 12, the same solve; "
       "L-stable but for 0.2° beside the imaginary axis, where it grows by up to 2 % a step"},
      {"taylor", "power series, adaptive", TaylorSeries<double>::order,
       TaylorSeries<double>::stable_real, TaylorSeries<double>::stable_imaginary,
       quintic_of_long_steps,
       "for wings of up to four panels in a row on a fixed base, without gravity, air, friction "
       "and real hinges, and with "
       "event latches: dop853 takes its place elsewhere"},
  };
  return list;
}

struct Deployment::Kept {
  std::vector<std::pair<int, int>> tree; ///< (parent, child) of every hinge of the scene before
  Wing<double> wing;
  Workspace<double> scratch;
};

Deployment::Deployment() : kept_(std::make_unique<Kept>()) {}
Deployment::~Deployment() = default;
Deployment::Deployment(Deployment&&) noexcept = default;
Deployment& Deployment::operator=(Deployment&&) noexcept = default;

namespace {

/// As the processor allows.
const Runs& runs() {
#ifdef WINGSPREAD_FMA_RUNS
  static const Runs& best = has_avx2() ? fma_runs() : plain_runs();
  return best;
#else
  return plain_runs();
#endif
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
  std::vector<std::pair<int, int>> tree(scene.hinges.size());
  std::transform(scene.hinges.begin(), scene.hinges.end(), tree.begin(),
                 [](const Hinge& hinge) { return std::pair(hinge.parent, hinge.child); });
  if (tree != kept_->tree || !has_room(kept_->wing, scene)) {
    kept_->wing = make_wing<double>(scene, outward_order(scene));
    kept_->tree = std::move(tree);
  }
  runs().set_parameters(kept_->wing, scene);
  return runs().alone(kept_->wing, kept_->scratch, integration, goal, observer);
}

DeploymentPack::DeploymentPack(InstructionSet set, const Integration& integration, const Goal& goal)
    : set_(set), how_(integration), goal_(goal), alone_(std::make_unique<Deployment>()) {}
DeploymentPack::~DeploymentPack() = default;
DeploymentPack::DeploymentPack(DeploymentPack&&) noexcept = default;
DeploymentPack& DeploymentPack::operator=(DeploymentPack&&) noexcept = default;

Occupancy DeploymentPack::run(Scene scene, const Next& next, const Done& done) {
  const Wing<double> structure = make_wing<double>(scene, outward_order(scene));
  std::optional<long> first = next(scene); // runs of other methods than its own are made alone
  Wing<double> wing_of_first = structure;
  if (first && has_room(structure, scene)) runs().set_parameters(wing_of_first, scene);
  const Method method = MethodChoice(how_, has_series(wing_of_first)).active();
  const auto next_run = [&] { return first ? std::exchange(first, std::nullopt) : next(scene); };
  const bool in_packs =
      set_ != InstructionSet::scalar && !how_.smoothing && !goal_.audit && has_lanes(method);
  if (!in_packs) {
    while (const std::optional<long> name = next_run())
      done(*name, alone_->run(scene, how_, goal_));
    return {};
  }
  const PackShape shape{method, goal_.peak_force, goal_.peak_moment, goal_.overtravel};
  const std::unique_ptr<PackEngine> engine = make_engine(set_, structure, shape);
  const auto next_wing = [&](Wing<double>& wing) -> std::optional<long> {
    while (const std::optional<long> name = next_run()) {
      const std::vector<Fault> faults = unphysical(scene);
      if (faults.empty() && has_room(structure, scene)) {
        runs().set_parameters(wing, scene);
        return name;
      }
      done(*name, faults.empty() ? alone_->run(scene, how_, goal_) : invalid(faults));
    }
    return std::nullopt;
  };
  return runs().in_lanes(structure, *engine, method, how_, goal_, next_wing, done);
}

} // namespace wingspread
