/// Scenes with a closed-form motion, and helpers for tests that compare whole runs with it.
///
/// | symbol | meaning                                          | unit    |
/// |--------|--------------------------------------------------|---------|
/// | I      | inertia of a panel about its hinge               | kg·m²   |
/// | κ      | stiffness of a spring that is linear in φ        | N·m/rad |
/// | τ_c    | Coulomb's kinetic level, τ_s ≥ τ_c: the static   | N·m     |
/// | u      | a hinge's angle from where its spring is at rest | rad     |
#pragma once

#include "core/deployment.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace wingspread::oracle {

/// I of latching_panel() and harmonic_panel(): J + m c², kg·m².
inline constexpr double panel_inertia = 0.5 + 10 * 0.5 * 0.5;

// ---- a constant moment

/// A hinge with constant acceleration at a distance `travel` from its latch. Positive: towards the latch.
struct ConstantDrive {
  double acceleration, travel, initial_rate = 0;

  [[nodiscard]] double rate() const {
    return std::sqrt(initial_rate * initial_rate + 2 * acceleration * travel);
  }
  [[nodiscard]] double time() const {
    return initial_rate < 0 ? (rate() - initial_rate) / acceleration
                            : 2 * travel / (rate() + initial_rate); // for a ≥ 0
  }
};

// ---- a linear spring

/// Gives the hinge a spring with M = −κ (φ − rest), wherever its latched angle is.
inline void pull_towards(Hinge& hinge, double rest, double stiffness) {
  const double sense = hinge.latched > hinge.stowed ? 1 : -1;
  hinge.spring = {-sense * stiffness * (hinge.stowed - rest),
                  -sense * stiffness * (hinge.latched - rest)};
}

/// The panel of latching_panel() on a spring about 0 with ω = 1 rad/s, released at φ = `start`
/// with `rate`; no latch.
inline Scene unit_oscillator(double start, double rate = 0) {
  Scene scene = latching_panel();
  Hinge& hinge = scene.hinges[0];
  hinge.stowed = start, hinge.latched = start - 1, hinge.initial_rate = rate;
  hinge.latch.reset();
  pull_towards(hinge, 0, panel_inertia);
  return scene;
}

// ---- dry friction

inline void rub(Hinge& hinge, double kinetic, std::optional<double> static_level = {}) {
  hinge.friction.model = FrictionModel::exact;
  hinge.friction.coulomb = kinetic;
  hinge.friction.static_level = static_level;
}

/// The motion by I ü = −κ u − b u̇ − friction. The hinge slides from one turning point to the next, each time about a
/// centre at +τ_c/κ or −τ_c/κ. It stops for good at the first turning point within τ_s/κ of u = 0. Underdamped, τ_c > 0.
class CoulombOscillator {
public:
  struct Law {
    double inertia, stiffness, viscous, kinetic, static_level;
  };
  struct State {
    double u, rate;
  };

  CoulombOscillator(const Law& law, State start)
      : law_(law), decay_(law.viscous / (2 * law.inertia)),
        omega_(std::sqrt(law.stiffness / law.inertia - decay_ * decay_)), end_(start) {
    while (end_.rate != 0 || std::abs(law_.stiffness * end_.u) > law_.static_level) slide();
  }

  /// The time at which the hinge stops for good.
  [[nodiscard]] double stop_time() const { return stop_; }

  [[nodiscard]] State at(double t) const {
    if (t >= stop_) return end_;
    auto slide = slides_.rbegin();
    while (slide->from > t) ++slide;
    return after(*slide, t - slide->from);
  }

private:
  struct Slide {
    double from, centre;
    State start;
  };

  void slide() {
    const double sense = end_.rate != 0 ? end_.rate : -end_.u;
    const Slide next{stop_, -std::copysign(law_.kinetic / law_.stiffness, sense), end_};
    double phase = std::atan2(end_.rate, sine_of_rate(next)); // at which the rate is next zero
    if (phase <= 0) phase += std::numbers::pi;
    slides_.push_back(next);
    stop_ += phase / omega_;
    end_ = {after(next, phase / omega_).u, 0};
  }

  /// The coefficient B in the rate of a slide, e^(−δt) (rate_0 cos ωt − B sin ωt).
  [[nodiscard]] double sine_of_rate(const Slide& slide) const {
    return omega_ * (slide.start.u - slide.centre) + decay_ * sine_of_angle(slide);
  }
  [[nodiscard]] double sine_of_angle(const Slide& slide) const {
    return (slide.start.rate + decay_ * (slide.start.u - slide.centre)) / omega_;
  }

  [[nodiscard]] State after(const Slide& slide, double t) const {
    const double e = std::exp(-decay_ * t), c = std::cos(omega_ * t), s = std::sin(omega_ * t);
    return {slide.centre + e * ((slide.start.u - slide.centre) * c + sine_of_angle(slide) * s),
            e * (slide.start.rate * c - sine_of_rate(slide) * s)};
  }

  Law law_;
  double decay_, omega_; ///< δ, ω
  double stop_ = 0;
  State end_;
  std::vector<Slide> slides_;
};

/// Two discs on one axis, on the hinges "first" (base to disc 1) and "second" (disc 1 to disc 2):
/// J_1 φ̈_1 = M_1 − M_2, J_2 (φ̈_1 + φ̈_2) = M_2. No springs, no latches; stowed at 0, latched at 1.
inline Scene coaxial_discs(double first_inertia, double second_inertia) {
  Scene scene;
  scene.name = "coaxial_discs";
  scene.bodies = {{"disc_1", 1, first_inertia}, {"disc_2", 1, second_inertia}};
  scene.hinges.resize(2);
  scene.hinges[0].name = "first", scene.hinges[1].name = "second";
  scene.hinges[1].parent = 0, scene.hinges[1].child = 1;
  for (Hinge& hinge : scene.hinges) hinge.latched = 1;
  return scene;
}

// ---- runs

/// Settings with relative tolerance `rtol`, absolute tolerance rtol/100 and fixed steps of `step`. A run that makes no
/// progress fails soon, after 200,000 steps.
inline Integration within(double rtol, double t_end, double step = 1e-3) {
  Integration how;
  how.rtol = rtol, how.atol = 1e-2 * rtol, how.t_end = t_end, how.step = step;
  how.max_steps = 200'000;
  return how;
}

inline const Goal to_the_end{.to_t_end = true};
inline const Goal latches_only{.peak_moment = false, .peak_force = false, .audit = false};

/// A bound of the error of an undamped oscillator with ω ≤ 1 after `steps` steps, each within its tolerance. Such errors
/// add up without growing. The factor 2 allows for the error of the rate, divided by ω.
inline double astray(const Integration& how, long steps, double size) {
  return 2 * static_cast<double>(steps) * (how.rtol * size + how.atol);
}

/// Whether the run failed and gave a reason.
inline bool gave_up(const Outcome& out) {
  return out.status == Status::failed && !out.reason.empty();
}

/// Whether nothing in the outcome is NaN or infinite.
inline bool finite(const Outcome& out) {
  const auto good = [](double x) { return std::isfinite(x); };
  const auto all = [&](const std::vector<double>& x) {
    return std::all_of(x.begin(), x.end(), good);
  };
  const auto peaks = [&](const std::vector<Peak>& x) {
    return std::all_of(x.begin(), x.end(),
                       [&](const Peak& p) { return good(p.value) && good(p.time); });
  };
  return good(out.t_end) && peaks(out.peak_moment) && peaks(out.peak_force) &&
         all(out.final.angles) && all(out.final.rates) && out.final.base_position.allFinite() &&
         out.final.base_velocity.allFinite() && good(out.final.base_angle) &&
         good(out.final.base_rate) && good(out.energy.initial) &&
         (out.status == Status::failed || // energies have squares, which overflow first
          (good(out.energy.final) && good(out.energy.drift_before_first_latch))) &&
         std::all_of(out.latches.begin(), out.latches.end(),
                     [&](const LatchEvent& e) { return good(e.time) && all(e.rates); });
}

/// The state at the end of a run, for DenseWing::balance.
inline WingState<long double> state_of(const Outcome& out, const DenseWing<long double>& wing) {
  WingState<long double> state = wing.initial_state();
  for (int i = 0; i < wing.size(); ++i)
    state.angles(i) = out.final.angles[i], state.rates(i) = out.final.rates[i];
  state.base_position = out.final.base_position.cast<long double>();
  state.base_velocity = out.final.base_velocity.cast<long double>();
  state.base_angle = out.final.base_angle, state.base_rate = out.final.base_rate;
  return state;
}

/// Which methods may end `failed` instead of giving the right answer.
enum class MayGiveUp {
  fixed_step, ///< runge_kutta4, which cannot reduce its step
  implicit,   ///< also rosenbrock_w and seulex: tiny steps after a release drown in round-off
  all_but_auto,
  all
};

inline bool may_give_up(const MethodInfo& method, MayGiveUp which) {
  if (method.name == "runge_kutta4") return true;
  if (which == MayGiveUp::fixed_step) return false;
  if (which == MayGiveUp::implicit) return method.name == "rosenbrock_w" || method.name == "seulex";
  return which == MayGiveUp::all || method.name != "auto";
}

/// The number of methods that may not give up.
inline int least_judged(MayGiveUp which) {
  const auto may = [&](const MethodInfo& method) { return may_give_up(method, which); };
  return static_cast<int>(std::ranges::count_if(methods(), std::not_fn(may)));
}

/// Runs the scene with every method and CHECKs each outcome. Only the methods that `which` names may give up; `judge`
/// checks all other outcomes. No value of any outcome may be NaN or infinite.
/// @param samples cleared and filled by every run, if given
/// @return the number of judged runs. Where all methods may give up it may be 0, so the caller should CHECK it
template <class Judge>
int with_every_method(const Scene& scene, Integration how, const Goal& goal, MayGiveUp which,
                      const Judge& judge, std::vector<Sample>* samples = nullptr) {
  Observer observer;
  if (samples) observer = [samples](const Sample& sample) { samples->push_back(sample); };
  int judged = 0;
  for (const MethodInfo& method : methods()) {
    how.method = method.name;
    if (samples) samples->clear();
    const Outcome out = Deployment().run(scene, how, goal, observer);
    INFO(method.name << ", rtol " << how.rtol << ": " << to_string(out.status) << " " << out.reason
                     << " at " << out.t_end << " s after " << out.work.steps << " + "
                     << out.work.rejected << " steps");
    CHECK(finite(out));
    CHECK(out.status != Status::invalid);
    if (out.status == Status::failed) {
      CHECK(gave_up(out));
      CHECK(may_give_up(method, which));
    } else if (out.status != Status::invalid) {
      judge(out);
      ++judged;
    }
  }
  CHECK(judged >= least_judged(which));
  return judged;
}

/// The same scene with its hinges listed in reverse order; its motion is the same.
inline Scene reversed(Scene scene) {
  std::reverse(scene.hinges.begin(), scene.hinges.end());
  return scene;
}

} // namespace wingspread::oracle
