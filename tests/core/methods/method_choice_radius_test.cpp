// What a radius that is measured anew means for the choice of `auto`.
#include "core/methods/method_choice.hpp"
#include "tests/support/closed_forms.hpp"

#include <catch2/catch.hpp>

#include <limits>

using namespace wingspread;
using namespace wingspread::oracle;

// Stability holds the explicit steps back. Where ρ falls they could be longer, and the implicit ones must gain more.
TEST_CASE("the implicit method is held against the steps that the explicit one could make now") {
  // pays: time that an implicit step integrates, as a part of what would pay at first; softer: by which ρ then falls
  for (const double pays : {0.4, 2.5})
    for (const double softer : {0.25, 1.0, 4.0}) {
      MethodChoice choice(within(1e-8, 1), false);
      choice.restart(0, 0, std::numeric_limits<double>::infinity(), true);
      choice.set_radius(1e3, 0, 0);
      const double h = choice.held_back().shortest * 1.01;
      double time = 0;
      long evaluations = 0;
      while (choice.active() == Method::dop853)
        (void)choice.after_step(h, time += h, evaluations += 12, 1.0);
      choice.set_radius(1e3 / softer, time, evaluations);
      bool leaves = false;
      for (int k = 0; k < 100 && !leaves; ++k) {
        const double step = pays * choice::implicit_cost * h * 30 / 12;
        leaves = choice.after_step(step, time += step, evaluations += 30, 1.0);
      }
      CAPTURE(pays, softer);
      CHECK(leaves == (pays < softer));
    }
}
