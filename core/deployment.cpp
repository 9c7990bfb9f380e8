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
       "5e-5 where there are series, taylor, "
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
    : set_(set), how_(integration), goal_(goal) {}

namespace {

/// Runs of a campaign whose wings call for one method or the other, friction or none: each goes through the engine of
/// its own. Those that are not the engine's wait, until it has made all others or they are many.
class Sorted {
public:
  Sorted(const Integration& how, const Goal& goal, InstructionSet set, Scene& scene,
         const DeploymentPack::Next& next, const DeploymentPack::Done& done)
      : choices_(first_choices(how)), how_(how), goal_(goal), set_(set), scene_(scene),
        structure_(make_wing<double>(scene, outward_order(scene))), next_(next), done_(done) {}

  [[nodiscard]] Occupancy run() {
    Occupancy all{};
    for (;;) {
      if (waiting_.empty()) {
        Wing<double> first = structure_;
        const std::optional<long> name = draw(first);
        if (!name) return all;
        waiting_.emplace_back(*name, first);
      }
      all += run_those_like(waiting_.front().second);
    }
  }

private:
  static constexpr std::size_t many =
      64; ///< packs enough that a last one with empty lanes does not count

  [[nodiscard]] Method method_of(const Wing<double>& wing) const {
    return choices_[has_series(wing) ? 1 : 0].active();
  }

  /// Those that wait, which are alike, and what is drawn until too many others wait.
  [[nodiscard]] Occupancy run_those_like(const Wing<double>& first) {
    const Method method = method_of(first);
    std::vector<std::pair<long, Wing<double>>> these = std::exchange(waiting_, {});
    const PackShape shape{method, goal_.peak_force, goal_.peak_moment, goal_.overtravel};
    const std::unique_ptr<PackEngine> engine = make_engine(set_, structure_, shape);
    const auto next_wing = [&](Wing<double>& wing) -> std::optional<long> {
      if (!these.empty()) {
        const long name = these.back().first;
        wing = these.back().second;
        these.pop_back();
        return name;
      }
      while (waiting_.size() < many) {
        const std::optional<long> name = draw(wing);
        if (!name || method_of(wing) == method) return name;
        waiting_.emplace_back(*name, wing);
      }
      return std::nullopt;
    };
    return runs().in_lanes(structure_, *engine, method, how_, goal_, next_wing, done_);
  }

  /// Sets the wing to that of the next run that an engine can make and returns its name; none when there are no more.
  [[nodiscard]] std::optional<long> draw(Wing<double>& wing) {
    while (!exhausted_) {
      const std::optional<long> name = next_(scene_);
      exhausted_ = !name;
      if (!name) break;
      const std::vector<Fault> faults = unphysical(scene_);
      if (faults.empty() && has_room(structure_, scene_)) {
        runs().set_parameters(wing, scene_);
        return name;
      }
      done_(*name, faults.empty() ? alone_.run(scene_, how_, goal_) : invalid(faults));
    }
    return std::nullopt;
  }

  const FirstChoices choices_;
  const Integration& how_;
  const Goal& goal_;
  const InstructionSet set_;
  Scene& scene_;
  const Wing<double> structure_;
  const DeploymentPack::Next& next_;
  const DeploymentPack::Done& done_;
  Deployment alone_;
  std::vector<std::pair<long, Wing<double>>> waiting_; ///< all of one method
  bool exhausted_ = false;
};

} // namespace

Occupancy DeploymentPack::run(Scene scene, const Next& next, const Done& done) {
  const bool in_packs = set_ != InstructionSet::scalar && !how_.smoothing && !goal_.audit &&
                        has_lanes(MethodChoice(how_, false).active());
  if (in_packs) return Sorted(how_, goal_, set_, scene, next, done).run();
  Deployment alone;
  while (const std::optional<long> name = next(scene)) done(*name, alone.run(scene, how_, goal_));
  return {};
}

} // namespace wingspread
