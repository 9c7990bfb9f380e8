// Synchronisation loops: whole runs against the rigid limit and closed forms.
#include "tests/core/deployment/real_runs.hpp"
#include "tests/support/random_cases.hpp"

#include <array>

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

namespace {

/// Damped so that the ringing after the start is over long before the latch.
EqualPanels compliant(const RigidPanels& rigid, double stiffness) {
  return {rigid.panels, rigid.mass, rigid.length, stiffness, 0.5 * std::sqrt(stiffness)};
}

Outcome run_panels(const RigidPanels& rigid, double stiffness, double rtol) {
  const Integration how = within(rtol, 40);
  const Outcome out = Deployment().run(compliant(rigid, stiffness).scene(), how, {});
  CAPTURE(stiffness, to_string(out.status), out.reason);
  REQUIRE(out.latches.size() == 1);
  return out;
}

/// Two discs on one axis, a loop of ratio 1 between their hinges: e = x_1 − x_2 swings by itself,
/// J ë = −τ(e), 1/J = 4/J_1 + 1/J_2.
Scene looped_discs(const Synchronisation& loop, double rate) {
  Scene scene = coaxial_discs(2, 0.5);
  scene.hinges[0].initial_rate = rate;
  scene.synchronisations = {loop};
  return scene;
}
constexpr double discs_inertia = 1 / (4 / 2. + 1 / 0.5);

Synchronisation cable(double stiffness) {
  Synchronisation loop;
  loop.name = "cable", loop.first = 0, loop.second = 1, loop.stiffness = stiffness;
  return loop;
}

/// After one period e and its rate have their first values again; the sum 2 J_1 φ_1 … drifts.
void check_period(const Scene& scene, double period, double rate) {
  const Outcome out = run_everywhere(scene, 1e-11, period, true);
  const auto &x = out.final.angles, &v = out.final.rates;
  CHECK(std::abs(x[0] - x[1]) < 1e-8);
  CHECK(std::abs(v[0] - v[1] - rate) < 1e-7);
}

/// e of two looped discs, J ë = −τ(e, ė), piece by piece in closed form: between events of slack strands the motion is that of
/// a damped oscillator about e_0.
class SlackSwing {
public:
  SlackSwing(const Synchronisation& loop, double rate)
      : loop_(loop), edge_(2 * *loop.preload / loop.stiffness), v_(rate) {}

  /// Moves on by a time. @return e and ė
  std::array<double, 2> after(double time) {
    for (double left = time; left > 0;) {
      side_ = side_after_edge();
      const double leaves = std::min(left, time_to_edge(left));
      const auto [e, v] = piece(leaves);
      e_ = e, v_ = v, left -= leaves;
      if (left > 0) e_ = std::copysign(edge_, e_);
    }
    return {e_, v_};
  }

private:
  /// −1, 0 or 1: beyond which edge e is, or will be at once.
  [[nodiscard]] int side_after_edge() const {
    if (std::abs(e_) < edge_) return 0;
    const bool outward = e_ * v_ > 0 || std::abs(e_) > edge_;
    return outward ? (e_ > 0 ? 1 : -1) : 0;
  }

  [[nodiscard]] std::array<double, 2> piece(double t) const {
    const double share = side_ == 0 ? 1 : 0.5;
    const double middle = side_ == 0 ? 0 : -side_ * edge_; // ½ K e + M_p sign e = ½ K (e + edge)
    const double decay = share * loop_.damping / (2 * discs_inertia);
    const double w = std::sqrt(share * loop_.stiffness / discs_inertia - decay * decay);
    const double a = e_ - middle, b = (v_ + decay * a) / w;
    const double c = std::cos(w * t), s = std::sin(w * t), f = std::exp(-decay * t);
    return {middle + f * (a * c + b * s), f * ((b * w - decay * a) * c - (a * w + decay * b) * s)};
  }

  /// When e leaves the piece, at most after `most`.
  [[nodiscard]] double time_to_edge(double most) const {
    const auto beyond = [&](double t) {
      const double e = piece(t)[0];
      return side_ == 0 ? std::abs(e) - edge_ : edge_ - side_ * e;
    };
    const double step = 1e-5; // far less than a crossing of the band takes
    double t = step;
    while (t < most && !(beyond(t) > 0)) t += step;
    if (t >= most) return most;
    double low = t - step, high = t;
    for (int k = 0; k < 60; ++k) {
      const double half = (low + high) / 2;
      (beyond(half) > 0 ? high : low) = half;
    }
    return high;
  }

  Synchronisation loop_;
  double edge_, e_ = 0, v_;
  int side_ = 0;
};

} // namespace

TEST_CASE("the loop of equal panels tends to the rigid one as it stiffens, as 1/K") {
  for (const RigidPanels& rigid : {RigidPanels{2, 5.5, 1.1}, RigidPanels{3, 10, 2}}) {
    const Arrival exact = rigid.latch();
    std::array<double, 3> time{}, rate{};
    for (int k = 0; k < 3; ++k) {
      const Outcome out = run_panels(rigid, std::pow(10, 4 + k), 1e-11);
      time[k] = out.latches[0].time, rate[k] = out.latches[0].rates[0];
    }
    for (int k = 0; k < 2; ++k) {
      const double times = (time[k] - exact.time) / (time[k + 1] - exact.time);
      const double rates = (rate[k] - exact.rate) / (rate[k + 1] - exact.rate);
      CAPTURE(rigid.panels, k, times, rates);
      CHECK(times == Approx(10).epsilon(0.1));
      CHECK(rates == Approx(10).epsilon(0.1));
    }
    // the error without its term 1/K, extrapolated from the last two: K^(−3/2), here 1e-9
    CAPTURE(rigid.panels, time[2], rate[2]);
    CHECK(relative((10 * time[2] - time[1]) / 9, exact.time) < 1e-7);
    CHECK(relative((10 * rate[2] - rate[1]) / 9, exact.rate) < 1e-7);
  }
}

TEST_CASE(
    "equal panels in closed form: time and rate of their latching, to the digits written down") {
  const auto check = [](const RigidPanels& rigid, double time, double rate) {
    const Outcome out = run_panels(rigid, 1e7, 1e-9);
    CHECK(std::abs(out.latches[0].time - time) < 2e-6);     // half a last digit, and 7/K
    CHECK(std::abs(out.latches[0].rates[0] - rate) < 6e-7); // 5/K
  };
  check({3, 10, 2}, 25.783141, 0.2604871);
  check({2, 5.5, 1.1}, 7.579898, 0.6239366);
}

TEST_CASE("stiff loops cost less than a hundred times as much as soft ones") {
  const RigidPanels rigid{3, 10, 2};
  const long soft = run_panels(rigid, 1e2, 1e-8).work.rhs_evaluations;
  for (const double stiffness : {1e4, 1e6, 1e8}) {
    const long stiff = run_panels(rigid, stiffness, 1e-8).work.rhs_evaluations;
    CAPTURE(stiffness, soft, stiff);
    CHECK(stiff < 30 * soft);
  }
}

TEST_CASE("equal panels in packs are equal panels alone") {
  for (const double stiffness : {1e2, 1e4})
    run_everywhere(compliant({3, 10, 2}, stiffness).scene(), 1e-8, 40);
}

TEST_CASE("a taut loop is a harmonic oscillator") {
  for (const double K : {10., 1e4}) {
    const double period = 2 * pi * std::sqrt(discs_inertia / K);
    check_period(looped_discs(cable(K), 1), period, 1);
    check_period(looped_discs(cable(K), -1), 5 * period, -1);
  }
}

TEST_CASE("a loop whose strand goes slack pulls with half its stiffness from there") {
  const double K = 100, v = 1;
  const double w = std::sqrt(K / discs_inertia), slack_w = w / std::sqrt(2);
  for (const double reach : {0.2, 0.7, 1.5}) { // 2 M_p/K, of the taut amplitude v/w
    const double edge = reach * v / w;
    Synchronisation loop = cable(K);
    loop.preload = K * edge / 2;
    double quarter = pi / (2 * w);
    if (reach < 1) { // to the edge taut; beyond it about −edge with ½ K
      const double left = std::sqrt(v * v - w * w * edge * edge);
      quarter = std::asin(reach) / w + std::atan2(left, slack_w * 2 * edge) / slack_w;
    }
    CAPTURE(reach);
    check_period(looped_discs(loop, v), 4 * quarter, v);
    check_period(looped_discs(loop, -v), 12 * quarter, -v);
  }
}

TEST_CASE("no step leaps over the angles at which both strands of a loop are taut and damp") {
  Draws draws(5);
  for (int k = 0; k < random_cases(200, 12); ++k) {
    Synchronisation loop = cable(draws.log_uniform(5, 200));
    loop.damping = draws.uniform(0.2, 0.7) * std::sqrt(loop.stiffness * discs_inertia);
    loop.preload = draws.log_uniform(1e-6, 1e-3) * loop.stiffness;
    const double time = draws.uniform(2, 4) * 2 * pi * std::sqrt(discs_inertia / loop.stiffness);
    const auto [e, v] = SlackSwing(loop, 1).after(time);
    for (const std::string method : {"auto", "dop853", "dopri5", "cash_karp54", "seulex"})
      for (const double rtol : {1e-6, 1e-9}) {
        Integration how = within(rtol, time, 1e-2);
        how.method = method;
        const Outcome out = Deployment().run(looped_discs(loop, 1), how, {.to_t_end = true});
        CAPTURE(k, loop.stiffness, loop.damping, *loop.preload, time, method, rtol, v);
        const double w = std::sqrt(loop.stiffness / discs_inertia);
        const double most = (method == "seulex" ? 10 : 1) * rtol + 1e-11;
        CHECK(std::abs(out.final.angles[0] - out.final.angles[1] - e) < most / w);
        CHECK(std::abs(out.final.rates[0] - out.final.rates[1] - v) < most);
      }
  }
}

TEST_CASE("loops by tables, damped and slack, agree with the reference", "[long]") {
  Scene scene = coaxial_discs(2, 0.5);
  scene.hinges[0].spring.torque_stowed = 1, scene.hinges[0].spring.torque_latched = 0.5;
  scene.hinges[0].latch = Latch{1e3, 10};
  Synchronisation loop = cable(50);
  loop.damping = 0.3, loop.preload = 0.2;
  tabulate(loop, {0, 0.3, 0.7, 1}, {0, 0.5, 0.8, 2});
  scene.synchronisations = {loop};
  const ReferenceOutcome exact = real_reference(scene, 4);
  const Outcome out = run_everywhere(scene, 1e-11, 4, true);
  check_latches(out, exact, 1e-8);
  for (int i = 0; i < 2; ++i) {
    CHECK(relative(out.peak_moment[i].value, exact.peak_moment[i].value) < 1e-6);
    CHECK(std::abs(out.final.angles[i] - exact.final.angles(i)) < 1e-8);
    CHECK(std::abs(out.final.rates[i] - exact.final.rates(i)) < 1e-7);
  }
}
