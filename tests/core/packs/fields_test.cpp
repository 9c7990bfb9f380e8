#include "core/mechanics/system.hpp"
#include "core/packs/fields.hpp"
#include "core/run/lane_protocol.hpp"
#include "tests/support/random_scenes.hpp"
#include "tests/support/real_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

using namespace wingspread;

namespace {

using P = Pack<2>;

/// Sets the numbers of a struct to next, next + 1, …
void number_all(double& field, double& next) { field = next++; }
template <class Struct> void number_all(Struct& all, double& next) {
  for_each_field(all, all, [&](auto& field, auto& /*same*/) { number_all(field, next); });
}
template <class Struct> [[nodiscard]] Struct numbered(double first) {
  Struct all{};
  number_all(all, first);
  return all;
}

/// Appends every number of a struct.
void append(double field, std::vector<double>& to) { to.push_back(field); }
template <class Struct> void append(const Struct& all, std::vector<double>& to) {
  for_each_field(all, all, [&](const auto& field, const auto& /*same*/) { append(field, to); });
}
template <class Struct> [[nodiscard]] std::vector<double> numbers_of(const Struct& all) {
  std::vector<double> numbers;
  append(all, numbers);
  return numbers;
}

/// Copies a Struct<double> into each lane of Struct<P> and out again. @param count of its numbers
template <template <class> class Struct> void require_way_and_back(std::size_t count) {
  const auto first = numbered<Struct<double>>(1), second = numbered<Struct<double>>(100);
  REQUIRE(numbers_of(first).size() == count);
  Struct<P> packs{};
  set_lane(0, packs, first);
  set_lane(1, packs, second);
  Struct<double> out{};
  get_lane(0, packs, out);
  REQUIRE(numbers_of(out) == numbers_of(first));
  get_lane(1, packs, out);
  REQUIRE(numbers_of(out) == numbers_of(second));
}

} // namespace

TEST_CASE("every number set in a lane comes back from it, whatever the other lanes contain") {
  require_way_and_back<Vec2>(2);
  require_way_and_back<LinearLaw>(4);
  require_way_and_back<BodyTerms>(12);
  require_way_and_back<StepHistory>(9);
}

TEST_CASE("a lane's structure is not copied, and a flag is set if any lane sets it") {
  Wing<double> wing{};
  wing.bodies.resize(2), wing.hinges.resize(2), wing.initial_rates = {0, 3};
  wing.hinges[1].static_friction = 5, wing.hinges[1].has_latch = true, wing.can_stick = true;
  Wing<P> packs;
  packs.bodies.resize(2), packs.hinges.resize(2), packs.initial_rates.resize(2);
  packs.base.motion = BaseMotion::free;
  set_lane(1, packs, wing);
  REQUIRE(packs.hinges[1].static_friction.v[1] == 5);
  REQUIRE(packs.hinges[1].static_friction.v[0] == 0);
  REQUIRE(packs.initial_rates[1].v[1] == 3);
  REQUIRE(packs.hinges[1].has_latch);
  REQUIRE(packs.base.motion == BaseMotion::free);
  wing.hinges[1].has_latch = wing.can_stick = false;
  set_lane(0, packs, wing);
  REQUIRE(packs.hinges[1].has_latch);
  REQUIRE(packs.can_stick);
}

TEST_CASE("assign_where copies all numbers of a struct, in the lanes of the mask only") {
  StepHistory<P> to{}, from{};
  set_lane(0, to, numbered<StepHistory<double>>(1)),
      set_lane(1, to, numbered<StepHistory<double>>(20));
  set_lane(0, from, numbered<StepHistory<double>>(300)),
      set_lane(1, from, numbered<StepHistory<double>>(4000));
  assign_where(to.steps > P(10.0), to, from); // lane 1
  StepHistory<double> out{};
  get_lane(0, to, out);
  REQUIRE(numbers_of(out) == numbers_of(numbered<StepHistory<double>>(1)));
  get_lane(1, to, out);
  REQUIRE(numbers_of(out) == numbers_of(numbered<StepHistory<double>>(4000)));
}

TEST_CASE("an idle lane computes finite numbers beside a run with any laws") {
  int dampers = 0, stops = 0, plates = 0, loops = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    oracle::RandomScene options;
    options.bodies = 3, options.motion = BaseMotion::fixed;
    const Scene scene = oracle::with_real_hinges(oracle::random_scene(seed, options), seed);
    Wing<double> run = make_wing<double>(scene, outward_order(scene));
    set_parameters(run, scene);
    Wing<P> wing;
    Workspace<P> work;
    System<P, Tree, BaseMotion::fixed> system(set_harmless(wing, run), std::nullopt, work);
    set_lane(0, wing, run);
    system.reset();
    State<P> x(system.layout().size(), P(0.0)), dxdt = x;
    for (const Hinge& hinge : scene.hinges) dampers += hinge.damper.has_value();
    for (const RealHingeTerms<double>& real : run.real) stops += real.stop.present;
    plates += !run.plates.empty(), loops += !run.loops.empty();
    for (const double rate : {0.0, 0.1}) { // of the run; the idle lane is at rest
      for (int i = 1; i <= system.layout().bodies; ++i) x[system.layout().rate(i)].v[0] = rate;
      system(x, dxdt, P(0.0));
      for (const P& component : dxdt) CHECK(std::isfinite(component.v[1]));
      for (int i = 1; i <= system.layout().bodies; ++i)
        CHECK(std::isfinite(system.moment(x, i).v[1]));
    }
  }
  CHECK(std::min({dampers, stops, plates, loops}) > 5);
}
