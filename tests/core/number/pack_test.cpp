// Packs of every width, lane by lane against numbers: also of widths for which this processor has no instructions.
#include "core/number/pack.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace wingspread;

namespace {

template <int W> void check_packs() {
  using P = Pack<W>;
  oracle::Draws draws(W);
  for (int trial = 0; trial < 200; ++trial) {
    P a(0.0), b(0.0), c(0.0);
    for (int lane = 0; lane < W; ++lane) {
      a.v[lane] = draws.uniform(-2, 2), c.v[lane] = draws.uniform(-2, 2);
      b.v[lane] = draws.chance(0.2) ? a.v[lane] : draws.uniform(-2, 2);
    }
    const P chosen = select(a < b, a, c), product = fused(a, b, c), root = sqrt(a * a),
            size = abs(a);
    for (int lane = 0; lane < W; ++lane) {
      const double x = a.v[lane], y = b.v[lane], z = c.v[lane];
      CAPTURE(W, trial, lane, x, y, z);
      CHECK((a + b).v[lane] == x + y);
      CHECK((a - b).v[lane] == x - y);
      CHECK((a * b).v[lane] == x * y);
      CHECK((a / b).v[lane] == x / y);
      CHECK((-a).v[lane] == -x);
      CHECK(chosen.v[lane] == (x < y ? x : z));
      CHECK(product.v[lane] == Approx(x * y + z).epsilon(1e-15).margin(1e-15));
      CHECK(root.v[lane] == std::sqrt(x * x));
      CHECK(size.v[lane] == std::abs(x));
      const auto holds = [&](const auto& mask) { return mask.bits[lane] != 0; };
      CHECK(holds(a < b) == (x < y));
      CHECK(holds(a > b) == (x > y));
      CHECK(holds(a <= b) == (x <= y));
      CHECK(holds(a >= b) == (x >= y));
      CHECK(holds(a == b) == (x == y));
      CHECK(holds(!(a < b)) == !(x < y));
      CHECK(holds(a < b && b < c) == (x < y && y < z));
      CHECK(holds(a < b || b < c) == (x < y || y < z));
    }
  }
  CHECK_FALSE(any(P(0.0) > P(0.0)));
  for (int lane = 0; lane < W; ++lane) { // whichever lane it is in
    P one(0.0);
    one.v[lane] = 1;
    CHECK(any(one > P(0.0)));
    CHECK(any(!(one < P(1.0))));
  }
}

} // namespace

TEST_CASE("every lane of a pack computes as a number does, and any() finds the one that is true") {
  check_packs<2>();
  check_packs<4>();
  check_packs<8>();
}
