/// What a step must satisfy beside its own error where a method takes long ones:
/// a dense output that shows what happens inside.
#pragma once

#include "core/dense/roughness.hpp"
#include "core/dense/step.hpp"
#include "core/mechanics/hinge_moment.hpp"
#include "core/methods/method.hpp"

namespace wingspread {

/// Makes a verdict obey the roughness of its step.
inline void limit_roughness(double rough, Verdict& verdict) {
  const double factor = factor_by_roughness(rough);
  verdict =
      rough > 1 ? Verdict{2, factor} : Verdict{verdict.error, std::min(verdict.factor, factor)};
}

/// The error of Fehlberg's quadrature of a smoothed latch's state (Fehlberg78 is blind to it), in
/// units of the tolerance: against Boole's rule on the dense output.
template <class T, class AnySystem>
[[nodiscard]] double quadrature_error(const AnySystem& system, const Step<T>& step,
                                      const Tolerance& tolerance) {
  using std::abs;
  const Layout& at = system.layout();
  double worst = 0;
  for (int i = 1; i <= at.bodies; ++i) {
    const HingeTerms<T>& hinge = system.wing().hinges[i];
    if (!hinge.has_latch) continue;
    const Quintic<T> angle = step.coordinate(at.angle(i), at.freedoms());
    const auto f = [&](double s) {
      return engagement_rate(hinge, value(angle, T(s)), system.epsilon());
    };
    const T boole =
        step.h / T(90) * (T(7) * (f(0) + f(1)) + T(32) * (f(0.25) + f(0.75)) + T(12) * f(0.5));
    const T S = step.x1[at.latch(i)], gained = S - step.x[at.latch(i)];
    worst = std::max(worst, static_cast<double>(T(abs(gained - boole))) /
                                (tolerance.atol + tolerance.rtol * static_cast<double>(S)));
  }
  return worst;
}

} // namespace wingspread
