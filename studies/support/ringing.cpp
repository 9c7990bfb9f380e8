#include "studies/support/ringing.hpp"

#include "studies/support/linear_wing.hpp"

#include <algorithm>
#include <numbers>

namespace wingspread::study {
namespace {

/// Follows the modes along a run.
class RingCounter {
public:
  RingCounter(const Scene& scene, const Integration& how)
      : wing_(scene), rtol_(how.rtol), atol_(how.atol), turns_(scene.hinges.size(), 0),
        engaged_(scene.hinges.size(), false) {}

  void engage(int hinge) {
    wing_.engage(hinge);
    engaged_[hinge] = true;
    last_look_ = -1; // the modes have changed: compute them again
  }

  void go_on(const Sample& from, const Sample& to) {
    count_turns(from, to);
    look(from);
    const double dt = to.t - from.t;
    const double turn = 2 * std::numbers::pi;
    ringing_.cycles += dt * fastest_above(tolerance()) / turn;
    ringing_.periods += dt * fastest_above(-1) / turn;
    for (std::size_t k = 0; k < modes_.size(); ++k) sizes_[k] *= std::exp(modes_[k].real() * dt);
  }

  [[nodiscard]] Ringing total() const {
    Ringing all = ringing_;
    all.seen = 0.5 * *std::ranges::max_element(turns_);
    return all;
  }

private:
  static constexpr double excitation = 1;  ///< rad/s, about the rate at which hinges latch
  static constexpr double interval = 1e-3; ///< s; modes change little within it

  void count_turns(const Sample& from, const Sample& to) {
    for (std::size_t i = 0; i < turns_.size(); ++i)
      if (engaged_[i] && from.rates[i] * to.rates[i] < 0) ++turns_[i];
  }

  void look(const Sample& at) {
    if (last_look_ >= 0 && at.t < last_look_ + interval) return;
    if (std::ranges::none_of(engaged_, [](bool e) { return e; })) return;
    modes_ = wing_.eigenvalues(wing_.state(at.angles, at.rates));
    if (last_look_ < 0) sizes_.assign(modes_.size(), excitation);
    sizes_.resize(modes_.size(), 0); // a pair may have become two real modes, or the reverse
    last_look_ = at.t;
    for (const Eigenvalue& mode : modes_)
      ringing_.fastest = std::max(ringing_.fastest, mode.imag());
  }

  /// The tolerance of the rates: absolute plus relative to the largest mode, rad/s.
  [[nodiscard]] double tolerance() const {
    return modes_.empty() ? 0 : atol_ + rtol_ * *std::ranges::max_element(sizes_);
  }

  /// The largest angular frequency of the modes whose size exceeds `size`, rad/s.
  [[nodiscard]] double fastest_above(double size) const {
    double fastest = 0;
    for (std::size_t k = 0; k < modes_.size(); ++k)
      if (sizes_[k] > size) fastest = std::max(fastest, modes_[k].imag());
    return fastest;
  }

  LinearWing wing_;
  double rtol_, atol_;
  std::vector<Eigenvalue> modes_;
  std::vector<double> sizes_; ///< of the modes, rad/s
  std::vector<int> turns_;
  std::vector<bool> engaged_;
  double last_look_ = -1;
  Ringing ringing_;
};

} // namespace

PureTone pure_tone() {
  Hinge hinge;
  hinge.name = "hinge", hinge.stowed = -1e-3, hinge.initial_rate = 1;
  hinge.latch = Latch{1e6, 0};
  PureTone tone{{"pure_tone", {}, {{"panel", 10, 0.5}}, {hinge}}, 0, 1000, 0};
  tone.omega = std::sqrt(hinge.latch->stiffness / tone.scene.bodies[0].inertia);
  const double latched_at = -hinge.stowed / hinge.initial_rate;
  tone.t_end = latched_at + tone.cycles * 2 * std::numbers::pi / tone.omega;
  return tone;
}

Ringing ringing_of(const Scene& scene, const Integration& how) {
  std::vector<Sample> samples;
  Deployment deployment;
  const Goal goal{.peak_moment = false, .peak_force = false, .audit = false, .to_t_end = true};
  const Outcome outcome =
      deployment.run(scene, how, goal, [&](const Sample& sample) { samples.push_back(sample); });
  RingCounter counter(scene, how);
  auto latch = outcome.latches.begin();
  for (std::size_t k = 0; k + 1 < samples.size(); ++k) {
    for (; latch != outcome.latches.end() && latch->time <= samples[k].t; ++latch)
      counter.engage(latch->hinge);
    counter.go_on(samples[k], samples[k + 1]);
  }
  return counter.total();
}

} // namespace wingspread::study
