/// The definition behind pack_kernel.hpp.
#pragma once

#include "core/laws/linear_law.hpp"
#include "core/mechanics/recursion.hpp"
#include "studies/support/pack_kernel.hpp"

#include <algorithm>
#include <array>
#include <chrono>

namespace wingspread::study {

template <class P, int N> struct PackKernel {
  Wing<P> wing;
  std::array<LinearLaw<P>, N + 1> laws;
  std::array<P, N> angles, rates, accelerations;

  PackKernel() {
    wing.bodies.resize(N + 1);
    for (int i = 1; i <= N; ++i) {
      const double v = 1 + 0.1 * i; // arbitrary numbers of a panel's magnitude
      wing.bodies[i] = {P(10 * v),
                        P(3 * v),
                        {P(5 * v), P(0.1)},
                        {P(v), P(0.02)},
                        {P(0.5), P(0.01)},
                        P(0.5),
                        P(-1 / (3 * v)),
                        P(v),
                        P(0.5)};
      laws[i] = {P(0.1), P(v), P(0.3), P(0.2)};
      angles[i - 1] = P(v), rates[i - 1] = P(0.1 * v);
    }
  }

  [[gnu::noinline]] void evaluate() {
    std::array<BodyFrame<P>, N + 1> frames;
    Chain<N> chain;
    BodyFrame<P>& base = frames[0];
    base.angle = base.rate = base.minus_rate_squared = base.angular_acceleration = P(0.0);
    base.acceleration = {P(0.0), P(0.0)};
    base.rotation = {P(0.0), P(1.0)};
    chain.outward([&](int i) __attribute__((always_inline)) {
      turn<BaseMotion::fixed>(chain, frames, i, angles[i - 1], rates[i - 1]);
    });
    chain.outward([&](int i) __attribute__((always_inline)) {
      place<BaseMotion::fixed>(wing, chain, frames, i);
    });
    chain.outward([&](int i) __attribute__((always_inline)) {
      frames[i].moment = linear_moment(laws[i], angles[i - 1], rates[i - 1]);
    });
    chain.inward([&](int i) __attribute__((always_inline)) { gather(wing, chain, frames, i); });
    chain.outward([&](int i) __attribute__((always_inline)) {
      accelerations[i - 1] = accelerate<BaseMotion::fixed>(chain, frames, i);
    });
  }

  /// Makes the next evaluation depend on this one, at the same state.
  void depend() {
    for (int i = 0; i < N; ++i) angles[i] = fused(P(1e-30), accelerations[i], angles[i]);
  }
};

/// The time of one evaluation per lane, ns, with `packs` packs evaluated alternately.
template <class P, int N, int packs, bool dependent> [[nodiscard]] double time_of_packs() {
  using Clock = std::chrono::steady_clock;
  std::array<PackKernel<P, N>, packs> kernels;
  double best = 1e30;
  constexpr int count = 1000;
  for (int round = 0; round < 500; ++round) {
    const auto start = Clock::now();
    for (int k = 0; k < count; ++k)
      for (PackKernel<P, N>& kernel : kernels) {
        kernel.evaluate();
        if (dependent) kernel.depend();
        asm volatile("" ::"r"(&kernel) : "memory");
      }
    best = std::min(best, std::chrono::duration<double, std::nano>(Clock::now() - start).count());
  }
  return best / count / packs / P::width;
}

template <class P, int N> [[nodiscard]] KernelTimes time_evaluation() {
  return {time_of_packs<P, N, 1, false>(), time_of_packs<P, N, 1, true>(),
          time_of_packs<P, N, 2, true>()};
}

} // namespace wingspread::study
