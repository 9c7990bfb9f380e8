#include "core/proofs/rest_model.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE(
    "a model of power dampers fits rates near those for which it was made, whatever their size") {
  for (const double tuned : {1e-4, 0.02, 1.0, 30.0}) {
    RestModel model;
    model.parents = {0, 1};
    model.remainders.resize(2);
    model.remainders[1].damper = DamperTerms<double>{};
    model.remainders[1].damper->rate = 1e-9; // below it the law is linear
    model.remainders[1].tuned_for = tuned;
    CHECK(model.depends_on_rates());
    HingeVector rates(2);
    rates << 17, 0; // a hinge without such a damper has any rate
    for (const double factor : {0.05, 0.25, 0.4, 1.0, 1.4, 1.6, 2.0, 100.0}) {
      CAPTURE(tuned, factor);
      rates(1) = factor * tuned;
      CHECK(model.is_tuned_for(rates) == (factor > 0.3 && factor < 1.5));
    }
    model.remainders[1].damper->rate = tuned; // slower rates are in the linear part
    rates(1) = 0;
    CHECK(model.is_tuned_for(rates));
    model.remainders[1].tuned_for = 0;
    CHECK((model.is_tuned_for(rates) && !model.depends_on_rates()));
  }
}
