#include "montecarlo/margin/window_search.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdlib>

using namespace wingspread;

namespace {

const SearchRange range{0.5, 2, 13, 0.01};

/// Condition k holds from its `from` to its `to`.
struct Span {
  double from, to;
};

Looks search(const std::vector<Span>& spans, const SearchRange& where = range) {
  return search_window(where, [&](double scale) {
    Failing failing;
    for (std::size_t k = 0; k < spans.size(); ++k)
      if (scale < spans[k].from || scale > spans[k].to) failing.insert(k);
    return failing;
  });
}

} // namespace

TEST_CASE("both edges are found to the tolerance, wherever they are", "[window]") {
  for (const double tolerance : {0.01, 1e-4})
    for (double lower = 0.512; lower < 1; lower += 0.0731)
      for (double upper = 1.9; upper > 1.05; upper -= 0.0917) {
        const Looks looks = search({{lower, 10}, {0, upper}}, {0.5, 2, 13, tolerance});
        const auto windows = windows_of(looks);
        REQUIRE(windows.size() == 1);
        const Window& found = windows.front();
        CHECK(found.lower >= lower);
        CHECK(*found.below < lower);
        CHECK(found.upper <= upper);
        CHECK(*found.above > upper);
        CHECK(found.lower / *found.below <= 1 + tolerance);
        CHECK(*found.above / found.upper <= 1 + tolerance);
        CHECK(looks.at(*found.below) == Failing{0});
        CHECK(looks.at(*found.above) == Failing{1});
        CHECK(looks.size() <= (tolerance == 0.01 ? 14u + 2 * 4 + 1 : 14u + 2 * 11 + 1));
        const double middle = *recommended(looks, tolerance);
        CHECK(looks.contains(middle));
        CHECK(middle == Approx(std::sqrt(found.lower * found.upper)).epsilon(tolerance / 5));
      }
}

TEST_CASE("a window narrower than the grid's cells is found between them", "[window]") {
  for (const double at : {0.531, 0.77, 1.02, 1.234, 1.95}) {
    const Looks looks = search({{at, 10}, {0, 1.012 * at}});
    REQUIRE(windows_of(looks).size() == 1);
    CHECK(windows_of(looks).front().lower >= at);
    CHECK(windows_of(looks).front().upper <= 1.012 * at);
    CHECK(closed_by(looks).empty());
    CHECK(looks.at(*recommended(looks, 0.01)).empty());
  }
}

TEST_CASE("edges that do not make the window are not sought", "[window]") {
  const Looks looks = search({{0.8, 10}, {0.7, 10}, {0, 1.3}, {0, 1.6}});
  CHECK(looks.size() <= 14u + 2 * 4 + 1);
  const auto other = windows_of(looks, 3);
  REQUIRE(other.size() == 1);
  CHECK(other.front().upper <= 1.6);
  CHECK(*other.front().above > 1.6);
  CHECK(*other.front().above / other.front().upper > 1.05);
}

TEST_CASE("an empty window is proven by those that never hold together", "[window]") {
  const Looks looks = search({{0.3, 10}, {1.3, 10}, {0, 1.1}});
  CHECK(windows_of(looks).empty());
  CHECK_FALSE(recommended(looks, 0.01));
  CHECK(closed_by(looks) == std::vector<std::size_t>{1, 2});
  for (const std::size_t condition : {1, 2}) { // and each of their edges is located
    const Window holds = windows_of(looks, condition).front();
    if (holds.below) CHECK(holds.lower / *holds.below <= 1.01);
    if (holds.above) CHECK(*holds.above / holds.upper <= 1.01);
  }
  CHECK(closed_by(search({{0, 10}, {3, 10}, {0, 1.1}})) == std::vector<std::size_t>{1});
  // no two of three: together they leave nothing
  const Looks three = search_window(range, [](double scale) {
    return scale < 0.8 ? Failing{0} : scale < 1.3 ? Failing{1} : Failing{2};
  });
  CHECK(closed_by(three) == std::vector<std::size_t>{0, 1, 2});
}

TEST_CASE("what holds up to an end of the range has no edge there", "[window]") {
  const auto windows = windows_of(search({{0.8, 10}}));
  REQUIRE(windows.size() == 1);
  CHECK((windows[0].below && !windows[0].above && windows[0].upper == 2));
  const Looks all = search({{0, 10}});
  CHECK(all.size() == 13); // 1 is the middle of the grid and of the window
  CHECK((!windows_of(all)[0].below && !windows_of(all)[0].above));
}

TEST_CASE("conditions that come and go make several windows, and the widest is taken", "[window]") {
  const Looks looks = search_window(range, [](double scale) {
    const bool holds = (scale > 0.6 && scale < 0.8) || (scale > 0.95 && scale < 1.5);
    return holds ? Failing{} : Failing{0};
  });
  const auto windows = windows_of(looks);
  REQUIRE(windows.size() == 2);
  CHECK(widest(windows) == &windows[1]);
  CHECK(windows[0].upper <= 0.8);
  CHECK(*windows[0].above / windows[0].upper <= 1.01);
  CHECK(*recommended(looks, 0.01) == Approx(std::sqrt(0.95 * 1.5)).epsilon(0.01));
}

TEST_CASE("a middle that fails splits the window", "[window]") {
  const Looks looks = search_window({0.5, 2, 4, 0.01}, [](double scale) {
    const bool hole = scale > 1.1 && scale < 1.2; // none of the grid's
    return scale < 0.7 || hole ? Failing{0} : Failing{};
  });
  const auto windows = windows_of(looks);
  REQUIRE(windows.size() == 2);
  CHECK(windows[0].upper <= 1.1);
  CHECK(windows[1].lower >= 1.2);
  CHECK(looks.at(*recommended(looks, 0.01)).empty());
}

TEST_CASE("scales have few digits, and 1 is among them", "[window]") {
  const Looks looks = search({{0.8123, 10}, {0, 1.377}});
  CHECK(looks.contains(1));
  for (const auto& [scale, failing] : looks) {
    char text[32];
    (void)std::snprintf(text, sizeof text, "%.4g", scale);
    CHECK(std::strtod(text, nullptr) == scale);
  }
  CHECK_FALSE(search({{0, 10}}, {1.2, 2, 3, 0.01}).contains(1));
}

TEST_CASE("a judge that throws ends the search", "[window]") {
  CHECK_THROWS_AS(search_window(range, [](double) -> Failing { throw 1; }), int);
}
