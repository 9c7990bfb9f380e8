#include "studies/peers/plain_odeint.hpp"

#include "studies/peers/dense_chain.hpp"

#include <boost/numeric/odeint.hpp>

#include <array>
#include <cmath>
#include <utility>

namespace wingspread::study {

namespace {

constexpr int n = 3;
using State = std::array<double, 2 * n>; // φ, then φ̇

class PlainWing {
public:
  explicit PlainWing(const Scene& scene) : hinges_(scene.hinges), chain_(scene) {}

  void engage(int i) { engaged_[i] = true; }
  [[nodiscard]] bool engaged(int i) const { return engaged_[i]; }
  [[nodiscard]] long evaluations() const { return evaluations_; }

  [[nodiscard]] double moment(const State& x, int i) const {
    const Hinge& hinge = hinges_[i];
    const double share = (x[i] - hinge.stowed) / (hinge.latched - hinge.stowed);
    const double sense = hinge.latched > hinge.stowed ? 1 : -1;
    double m = sense * std::lerp(hinge.spring.torque_stowed, hinge.spring.torque_latched, share);
    if (engaged_[i])
      m -= hinge.latch->stiffness * (x[i] - hinge.latched) + hinge.latch->damping * x[n + i];
    return m;
  }

  void operator()(const State& x, State& dxdt, double /*t*/) {
    ++evaluations_;
    DenseChain<n>::Vector angle, rate, moments, acceleration;
    for (int i = 0; i < n; ++i) {
      angle[i] = x[i] + (i > 0 ? angle[i - 1] : 0.0);
      rate[i] = x[n + i] + (i > 0 ? rate[i - 1] : 0.0);
      moments[i] = moment(x, i);
    }
    chain_.accelerate(angle, rate, moments, acceleration);
    for (int i = 0; i < n; ++i) {
      dxdt[i] = x[n + i];
      dxdt[n + i] = acceleration[i] - (i > 0 ? acceleration[i - 1] : 0.0);
    }
  }

private:
  const std::vector<Hinge>& hinges_;
  DenseChain<n> chain_;
  std::array<bool, n> engaged_{};
  long evaluations_ = 0;
};

} // namespace

PlainOutcome plain_odeint(const Scene& scene, double rtol, double t_end, bool first_latch_only) {
  namespace odeint = boost::numeric::odeint;
  PlainWing wing(scene);
  PlainOutcome out{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n), 0};
  State x{};
  for (int i = 0; i < n; ++i) x[i] = scene.hinges[i].stowed;
  const auto gap = [&](const State& at, int i) {
    const Hinge& hinge = scene.hinges[i];
    return (at[i] - hinge.latched) * (hinge.latched > hinge.stowed ? 1 : -1);
  };
  const auto observe = [&](const State& at) {
    for (int i = 0; i < n; ++i)
      out.peak_moment[i] = std::max(out.peak_moment[i], std::abs(wing.moment(at, i)));
  };
  auto stepper = odeint::make_dense_output(0.01 * rtol, rtol, odeint::runge_kutta_dopri5<State>());
  stepper.initialize(x, 0.0, 1e-4);
  for (bool done = false; !done;) {
    auto [from, to] = stepper.do_step(std::ref(wing));
    State end, at;
    stepper.calc_state(to, end);
    int first = -1;
    double when = std::min(to, t_end);
    for (int i = 0; i < n; ++i) {
      if (wing.engaged(i) || gap(end, i) < 0) continue;
      double low = from, high = when;
      stepper.calc_state(high, at);
      if (gap(at, i) < 0) continue;
      for (int pass = 0; pass < 50 && high - low > 1e-15 * high; ++pass) {
        const double middle = 0.5 * (low + high);
        stepper.calc_state(middle, at);
        (gap(at, i) < 0 ? low : high) = middle;
      }
      first = i, when = high;
    }
    if (!first_latch_only)
      for (int k = 1; k <= 16; ++k) {
        stepper.calc_state(from + (when - from) * k / 16, at);
        observe(at);
      }
    done = when >= t_end;
    if (first < 0) continue;
    stepper.calc_state(when, at);
    out.latch_time[first] = when, out.latch_rate[first] = at[n + first];
    wing.engage(first);
    observe(at);
    done = done || first_latch_only;
    stepper.initialize(at, when, std::min(1e-4, to - from));
  }
  out.evaluations = wing.evaluations();
  return out;
}

} // namespace wingspread::study
