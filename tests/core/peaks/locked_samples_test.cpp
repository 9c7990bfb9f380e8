#include "core/peaks/locked_samples.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE("the searches of a step share the evaluations inside it") {
  const Scene scene = oracle::seed_scene();
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  Workspace<double> work;
  System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
  State<double> x;
  system.start(x);
  system.set_contact(2, Contact::held);

  LockedSamples<double> samples;
  int evaluations = 0;
  const auto evaluate = [&](double s) -> const State<double>& {
    ++evaluations;
    work.holding.assign(work.holding.size(), s);
    return x;
  };
  const auto at = [&](double s) { return samples.at(s, system, true, evaluate); };
  samples.begin();
  for (int k = 1; k <= 15; ++k) CHECK(at(k / 16.0).moments[1] == k / 16.0);
  CHECK(evaluations == 15);
  for (int k = 1; k <= 15; ++k) {
    CHECK(at(k / 16.0).moments[1] == k / 16.0);
    CHECK(at(k / 16.0).borne[2] == k / 16.0 - system.sliding_moment(x, 2));
  }
  CHECK(evaluations == 15);
  for (const double more : {0.3, 0.7}) CHECK(at(more).moments[1] == more); // beyond those kept
  CHECK(at(0.5).moments[1] == 0.5);
  CHECK(evaluations == 17);
  samples.begin();
  CHECK(at(0.5).moments[1] == 0.5);
  CHECK(evaluations == 18);
}
