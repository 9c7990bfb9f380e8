// When `auto` tries the implicit method again after trials that did not pay.
#include "core/methods/method_choice.hpp"
#include "tests/support/closed_forms.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE("after a vain trial auto waits, twice as long after each up to a limit, and anew after a "
          "trial that has paid") {
  MethodChoice choice(within(1e-8, 1), false);
  choice.restart(0, 0, std::numeric_limits<double>::infinity(), true);
  choice.set_radius(1e3, 0, 0);
  const double h = choice.held_back().shortest * 1.01;
  double time = 0;
  long evaluations = 0;
  const auto steps_until = [&](Method method, double step, int cost) {
    long steps = 0;
    for (; choice.active() != method && steps < 10000; ++steps)
      (void)choice.after_step(step, time += step, evaluations += cost, 1.0);
    return steps;
  };
  // an implicit step costs 30 evaluations
  const auto implicit = [&](double pays) { return pays * choice::implicit_cost * h * 30 / 12; };
  CHECK(static_cast<double>(steps_until(Method::seulex, h, 12)) == HeldBackSteps<double>::enough);
  for (long wait = choice::first_retry; wait <= 2 * choice::longest_retry; wait *= 2) {
    CHECK(steps_until(Method::dop853, implicit(0.2), 30) < 50);
    CAPTURE(wait);
    CHECK(steps_until(Method::seulex, h, 12) == std::min<long>(wait, choice::longest_retry));
  }
  for (int k = 0; k < 100; ++k)
    (void)choice.after_step(implicit(5), time += implicit(5), evaluations += 30, 1.0);
  REQUIRE(choice.active() == Method::seulex);
  CHECK(steps_until(Method::dop853, implicit(0.2), 30) < 50);
  CHECK(steps_until(Method::seulex, h, 12) == choice::first_retry);
}
