#include "distributions/distribution.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <type_traits>
#include <variant>

using namespace wingspread;

namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// All faults of a distribution, one a line: "path: found, expected".
std::string report(const Law& law, std::optional<Truncation> truncate = {}) {
  std::string lines;
  for (const DistributionFault& f : faults({law, truncate}))
    lines += (lines.empty() ? "" : "\n") + f.path + ": " + f.found + ", " + f.expected;
  return lines;
}

} // namespace

TEST_CASE("laws that are sound have no faults") {
  CHECK(report(Normal{1, 0.05}) == "");
  CHECK(report(Uniform{-1, 1}) == "");
  CHECK(report(Triangular{0, 0, 1}) == "");
  CHECK(report(Triangular{0, 1, 1}) == "");
  CHECK(report(Lognormal{0, 0.1}) == "");
  CHECK(report(Weibull{2, 3}) == "");
  CHECK(report(Gamma{2, 3}) == "");
  CHECK(report(Beta{2, 3, -1, 1}) == "");
  CHECK(report(Exponential{2}) == "");
  CHECK(report(Discrete{{1, 2}, {0, 3}}) == "");
  CHECK(report(Empirical{{1, 1}}) == "");
  CHECK(report(Constant{0}) == "");
  CHECK(report(Normal{1, 0.05}, Truncation{0.9, unbounded}) == "");
  CHECK(report(Normal{}, Truncation{}) == "");
}

TEST_CASE("what must be positive is") {
  CHECK(report(Normal{1, 0}) == "std: 0, > 0");
  CHECK(report(Lognormal{1, -0.25}) == "sigma_log: -0.25, > 0");
  CHECK(report(Exponential{0}) == "rate: 0, > 0");
}

TEST_CASE("all faults of a law are reported together") {
  CHECK(report(Weibull{-1, 0}) == "shape: -1, > 0\nscale: 0, > 0");
  CHECK(report(Gamma{0, not_a_number}) == "shape: 0, > 0 and ≤ 1e6\nscale: nan, a finite number");
  CHECK(report(Gamma{2e6, 1}) ==
        "shape: 2e+06, > 0 and ≤ 1e6"); // inverses that Boost would not find
  CHECK(report(Beta{0, -1, unbounded, 1}) ==
        "alpha: 0, > 0 and ≤ 1e6\nbeta: -1, > 0 and ≤ 1e6\nlower: inf, a finite number");
  CHECK(report(Normal{not_a_number, 0}, Truncation{2, 1}) ==
        "mean: nan, a finite number\nstd: 0, > 0\ntruncate/upper: 1, > lower (2)");
}

TEST_CASE("one fault does not hide another") {
  CHECK(report(Beta{0, 1, 2, 1}) == "alpha: 0, > 0 and ≤ 1e6\nupper: 1, > lower (2)");
  CHECK(report(Triangular{2, 0, 1}) == "upper: 1, > lower (2)"); // no mode would do
  CHECK(report(Discrete{{1, not_a_number}, {0, 0}}) ==
        "values/1: nan, a finite number\nweights: all zero, at least one > 0");
  CHECK(report(Discrete{{1, 2}, {}}) == "weights: none, at least one");
  CHECK(report(Discrete{{1, 2}, {unbounded, 1}}) == "weights/0: inf, a finite number");
}

TEST_CASE("what must be finite is") {
  CHECK(report(Constant{-unbounded}) == "value: -inf, a finite number");
  CHECK(report(Uniform{not_a_number, 1}) == "lower: nan, a finite number");
  CHECK(report(Empirical{{1, not_a_number}}) == "values/1: nan, a finite number");
}

TEST_CASE("bounds are in order, with the mode between them") {
  CHECK(report(Uniform{1, 1}) == "upper: 1, > lower (1)");
  CHECK(report(Uniform{1e308, -1e308}) == "upper: -1e+308, > lower (1e+308)");
  CHECK(report(Uniform{-8e307, 8e307}).empty());
  for (const std::string& wide :
       {report(Uniform{-1e308, 1e308}), report(Triangular{-1e308, 0, 1e308}),
        report(Beta{1, 1, -1e308, 1e308})})
    CHECK(wide == "upper: 1e+308, a finite distance to lower (-1e+308)");
  CHECK(report(Beta{1, 1, 2, 1}) == "upper: 1, > lower (2)");
  CHECK(report(Triangular{0, 1.5, 1}) == "mode: 1.5, in [lower, upper] = [0, 1]");
  CHECK(report(Triangular{0, -0.1, 1}) == "mode: -0.1, in [lower, upper] = [0, 1]");
}

TEST_CASE("values and weights pair up and weigh something") {
  CHECK(report(Discrete{{}, {}}) == "values: none, at least one\nweights: none, at least one");
  CHECK(report(Empirical{}) == "values: none, at least one");
  CHECK(report(Discrete{{1, 2, 3}, {1, 2}}) == "weights: 2, one for each of the 3 values");
  CHECK(report(Discrete{{1, 2}, {0.5, -0.5}}) == "weights/1: -0.5, ≥ 0");
  CHECK(report(Discrete{{1, 2}, {0, 0}}) == "weights: all zero, at least one > 0");
  CHECK(report(Discrete{{1, 2}, {1e308, 1e308}}) == "weights: a sum of inf, a finite sum");
}

TEST_CASE("a truncation is an interval of a continuous law that holds some probability") {
  const std::string none = ", an interval in which the law has a probability that doubles can hold";
  CHECK(report(Normal{}, Truncation{1, 1}) == "truncate/upper: 1, > lower (1)");
  CHECK(report(Normal{}, Truncation{not_a_number, 1}) == "truncate/lower: nan, a number");
  CHECK(report(Normal{}, Truncation{0, not_a_number}) == "truncate/upper: nan, a number");
  CHECK(report(Normal{}, Truncation{unbounded, unbounded}) == "truncate/upper: inf, > lower (inf)");
  CHECK(report(Normal{}, Truncation{40, 41}) == "truncate: [40, 41]" + none);
  CHECK(report(Uniform{0, 1}, Truncation{-2, -1}) == "truncate: [-2, -1]" + none);
  CHECK(report(Uniform{0, 1}, Truncation{-2, 0}) == "truncate: [-2, 0]" + none);
  CHECK(report(Weibull{2, 1}, Truncation{-2, -1}) == "truncate: [-2, -1]" + none);
  CHECK(report(Normal{}, Truncation{37, 38}) == "");
  CHECK(report(Discrete{{1}, {1}}, Truncation{0, 2}) ==
        "truncate: a truncated discrete law, a continuous law");
  CHECK(report(Constant{1}, Truncation{0, 2}) ==
        "truncate: a truncated constant law, a continuous law");
  CHECK(report(Empirical{{1}}, Truncation{0, 2}) ==
        "truncate: a truncated empirical law, a continuous law");
}

namespace {

/// Whether a law has no fault when one of its parameters is this, as `Value` or as the vector's only element.
template <class L, class Value> bool is_sound_with(Value L::*member, double number) {
  L law;
  if constexpr (std::is_same_v<L, Discrete>) law.values = {1, 2}, law.weights = {1, 1};
  if constexpr (std::is_same_v<L, Empirical>) law.values = {1};
  if constexpr (std::is_same_v<Value, double>)
    law.*member = number;
  else
    (law.*member)[0] = number;
  return faults({law, {}}).empty();
}

template <class L> void check_ranges_of_parameters() {
  constexpr double least = std::numeric_limits<double>::denorm_min();
  for (const auto& [name, member, range] : L::parameters()) {
    CAPTURE(L::type, name);
    for (const double never : {unbounded, -unbounded, not_a_number})
      CHECK_FALSE(is_sound_with<L>(member, never));
    if (range == Range::finite) continue;
    CHECK(is_sound_with<L>(member, 1e-3));
    CHECK(is_sound_with<L>(member, least));
    CHECK(is_sound_with<L>(member, 0) == (range == Range::non_negative));
    CHECK_FALSE(is_sound_with<L>(member, -least));
    CHECK(is_sound_with<L>(member, largest_shape));
    CHECK(is_sound_with<L>(member, std::nextafter(largest_shape, 1e9)) == (range != Range::shape));
  }
}

template <class... L> void check_ranges_of_all(const std::variant<L...>& /*any*/) {
  (check_ranges_of_parameters<L>(), ...);
}

} // namespace

TEST_CASE("every parameter's range is closed or open as it says, up to the last double") {
  check_ranges_of_all(Law{});
}

TEST_CASE("a law of which nothing is said is the standard one of its kind") {
  const auto check = [](const Law& law, double mean, double deviation) {
    const LawMoments found = moments(law);
    CAPTURE(law.index());
    CHECK(found.mean == Approx(mean).epsilon(1e-14).margin(1e-15));
    CHECK(found.standard_deviation == Approx(deviation).epsilon(1e-14));
    CHECK(report(law) == "");
  };
  check(Normal{}, 0, 1);
  check(Uniform{}, 0.5, std::sqrt(1 / 12.));
  check(Triangular{}, 0.5, std::sqrt(1 / 24.));
  check(Lognormal{}, std::exp(0.5), std::sqrt(std::exp(2) - std::exp(1)));
  check(Weibull{}, 1, 1);
  check(Gamma{}, 1, 1);
  check(Beta{}, 0.5, std::sqrt(1 / 12.));
  check(Exponential{}, 1, 1);
  check(Constant{}, 0, 0);
}

TEST_CASE("a law's parameters can be read by name") {
  Law law = Triangular{1, 2, 3};
  std::string names;
  double sum = 0;
  for (const auto& [name, member, range] : Triangular::parameters()) {
    names += std::string(name) + " ";
    sum += std::get<Triangular>(law).*member;
  }
  CHECK(names == "lower mode upper ");
  CHECK(sum == 6);
  CHECK(std::visit([](const auto& l) { return l.type; }, law) == "triangular");
}

TEST_CASE("the moments of laws whose values can be counted") {
  const LawMoments discrete = moments(Discrete{{1, 3}, {3, 1}});
  CHECK(discrete.mean == 1.5);
  CHECK(discrete.standard_deviation == Approx(std::sqrt(0.75)).epsilon(1e-15));
  const LawMoments data = moments(Empirical{{1, 2, 3, 6}});
  CHECK(data.mean == 3);
  CHECK(data.standard_deviation == Approx(std::sqrt(3.5)).epsilon(1e-15)); // of the law: over n
  CHECK(moments(Constant{4}).mean == 4);
  CHECK(moments(Constant{4}).standard_deviation == 0);
}
