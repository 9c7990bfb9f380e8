#include "montecarlo/analyses/margin/window_search.hpp"

#include <catch2/catch.hpp>

#include <cstdlib>

using namespace wingspread;

namespace {

const SearchRange range{0.5, 2, 13, 0.01};

/// Condition k holds from its `from` to its `to`.
struct Span {
  double from, to;
};

FailingByScale search(const std::vector<Span>& spans, const SearchRange& where = range) {
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
        const FailingByScale by_scale = search({{lower, 10}, {0, upper}}, {0.5, 2, 13, tolerance});
        const auto windows = windows_of(by_scale);
        REQUIRE(windows.size() == 1);
        const Window& found = windows.front();
        CHECK(found.lower >= lower);
        CHECK(*found.below < lower);
        CHECK(found.upper <= upper);
        CHECK(*found.above > upper);
        CHECK(found.lower / *found.below <= 1 + tolerance);
        CHECK(*found.above / found.upper <= 1 + tolerance);
        CHECK(by_scale.at(*found.below) == Failing{0});
        CHECK(by_scale.at(*found.above) == Failing{1});
        CHECK(by_scale.size() <= (tolerance == 0.01 ? 14u + 2 * 4 + 1 : 14u + 2 * 11 + 1));
      }
}

TEST_CASE("a window narrower than the grid's cells is found between them", "[window]") {
  for (const double at : {0.531, 0.77, 1.02, 1.234, 1.95}) {
    const FailingByScale by_scale = search({{at, 10}, {0, 1.012 * at}});
    REQUIRE(windows_of(by_scale).size() == 1);
    CHECK(windows_of(by_scale).front().lower >= at);
    CHECK(windows_of(by_scale).front().upper <= 1.012 * at);
    CHECK(closed_by(by_scale).empty());
  }
}

TEST_CASE("edges that do not make the window are not sought", "[window]") {
  const FailingByScale by_scale = search({{0.8, 10}, {0.7, 10}, {0, 1.3}, {0, 1.6}});
  CHECK(by_scale.size() <= 14u + 2 * 4 + 1);
  const auto other = windows_of(by_scale, 3);
  REQUIRE(other.size() == 1);
  CHECK(other.front().upper <= 1.6);
  CHECK(*other.front().above > 1.6);
  CHECK(*other.front().above / other.front().upper > 1.05);
}

TEST_CASE("an empty window is proven by those that never hold together", "[window]") {
  const FailingByScale by_scale = search({{0.3, 10}, {1.3, 10}, {0, 1.1}});
  CHECK(windows_of(by_scale).empty());
  CHECK(closed_by(by_scale) == std::vector<std::size_t>{1, 2});
  for (const std::size_t condition : {1, 2}) { // and each of their edges is located
    const Window holds = windows_of(by_scale, condition).front();
    if (holds.below) CHECK(holds.lower / *holds.below <= 1.01);
    if (holds.above) CHECK(*holds.above / holds.upper <= 1.01);
  }
  CHECK(closed_by(search({{0, 10}, {3, 10}, {0, 1.1}})) == std::vector<std::size_t>{1});
  // all that never hold, not the first of them
  CHECK(closed_by(search({{3, 10}, {0, 1.1}, {0, 0.01}})) == std::vector<std::size_t>{0, 2});
  // no two of three: together they leave nothing
  const FailingByScale three = search_window(range, [](double scale) {
    return scale < 0.8 ? Failing{0} : scale < 1.3 ? Failing{1} : Failing{2};
  });
  CHECK(closed_by(three) == std::vector<std::size_t>{0, 1, 2});
}

TEST_CASE("a window may lie between scales of which none has a failing condition in common",
          "[window]") {
  using Cells = std::vector<std::pair<double, double>>;
  const Failing low{0}, high{1}, both{0, 1};
  CHECK(unresolved_cells({{1, low}, {1.36, low}, {1.45, high}, {2, high}}) == Cells{{1.36, 1.45}});
  CHECK(unresolved_cells({{1, low}, {1.4, both}, {2, high}}).empty());
  CHECK(unresolved_cells({{1, low}, {1.4, {}}, {2, high}}).empty()); // a window
  CHECK(unresolved_cells({{1, low}, {1.2, high}, {1.4, low}}) == Cells{{1, 1.2}, {1.2, 1.4}});
}

TEST_CASE("what holds up to an end of the range has no edge there", "[window]") {
  const auto windows = windows_of(search({{0.8, 10}}));
  REQUIRE(windows.size() == 1);
  CHECK((windows[0].below && !windows[0].above && windows[0].upper == 2));
  const FailingByScale all = search({{0, 10}});
  CHECK(all.size() == 13); // 1 is the middle of the grid and of the window
  CHECK((!windows_of(all)[0].below && !windows_of(all)[0].above));
}

TEST_CASE("conditions that come and go make several windows, and the widest is taken", "[window]") {
  const FailingByScale by_scale = search_window(range, [](double scale) {
    const bool holds = (scale > 0.6 && scale < 0.8) || (scale > 0.95 && scale < 1.5);
    return holds ? Failing{} : Failing{0};
  });
  const auto windows = windows_of(by_scale);
  REQUIRE(windows.size() == 2);
  CHECK(widest(windows) == &windows[1]);
  CHECK(windows[0].upper <= 0.8);
  CHECK(*windows[0].above / windows[0].upper <= 1.01);
}

TEST_CASE("an end at which nothing fails is no edge: by_scale go on until there is one",
          "[window]") {
  const FailingByScale by_scale = search({{0.21, 100}, {0, 3.3}}, {0.5, 2, 13, 0.01, 0.0625, 16});
  REQUIRE(windows_of(by_scale).size() == 1);
  const Window found = windows_of(by_scale).front();
  CHECK((found.lower >= 0.21 && *found.below < 0.21 && found.lower / *found.below <= 1.01));
  CHECK((found.upper <= 3.3 && *found.above > 3.3 && *found.above / found.upper <= 1.01));
  CHECK(by_scale.begin()->first == 0.1768); // 0.5 / √2³: the first that fails
  CHECK(by_scale.rbegin()->first == 3.999); // 2 · √2², of four digits each time
  CHECK(by_scale.size() <= 13u + 3 + 2 + 2 * 6);
}

TEST_CASE("the range is widened to its limits, and no further", "[window]") {
  const FailingByScale by_scale = search({{0.02, 100}, {0, 100}}, {0.5, 2, 13, 0.01, 0.1, 5});
  CHECK((by_scale.begin()->first == 0.1 && by_scale.rbegin()->first == 5));
  const Window found = windows_of(by_scale).front();
  CHECK((!found.below && !found.above));
  // What fails at an end, and holds further in, has its edge there.
  const FailingByScale narrow = search({{0.8, 100}, {0, 1.3}}, {0.5, 2, 13, 0.01, 0.1, 5});
  CHECK((narrow.begin()->first == 0.5 && narrow.rbegin()->first == 2));
}

TEST_CASE("a window that lies beyond the range is found", "[window]") {
  const FailingByScale by_scale = search({{2.7, 100}, {0, 3.5}}, {0.5, 2, 13, 0.01, 0.0625, 16});
  REQUIRE(windows_of(by_scale).size() == 1);
  CHECK((windows_of(by_scale).front().lower >= 2.7 && windows_of(by_scale).front().upper <= 3.5));
  CHECK(by_scale.begin()->first == 0.0625); // for the first never held down there: it might have
  // What does not hold anywhere is sought for on both sides, where nothing else speaks against it.
  CHECK(closed_by(search({{0, 0.01}}, {0.5, 2, 5, 0.01, 0.25, 4})) == std::vector<std::size_t>{0});
}

TEST_CASE("scales have few digits, and 1 is among them", "[window]") {
  const FailingByScale by_scale = search({{0.8123, 10}, {0, 1.377}});
  CHECK(by_scale.contains(1));
  for (const auto& [scale, failing] : by_scale) {
    char text[32];
    (void)std::snprintf(text, sizeof text, "%.4g", scale);
    CHECK(std::strtod(text, nullptr) == scale);
  }
  CHECK(search({{0, 10}}, {1.2, 2, 3, 0.01}).contains(1)); // though it is not in the range
}

TEST_CASE("a judge that throws ends the search", "[window]") {
  CHECK_THROWS_AS(search_window(range, [](double) -> Failing { throw 1; }), int);
}

TEST_CASE("the bound of how many by_scale there will be falls, and is kept to") {
  const SearchRange range{0.5, 2, 13, 0.01, 0.125, 8};
  CHECK(first_scales(range).size() == 13); // 1 is the middle one
  CHECK(first_scales({0.7, 2, 13, 0.01}).size() == 14);
  const auto between = [](double lower, double upper) {
    return [=](double scale) {
      Failing failing;
      if (scale < lower) failing.insert(0);
      if (scale > upper) failing.insert(1);
      if (scale > 0.9 && scale < 0.91) failing.insert(2); // comes and goes
      return failing;
    };
  };
  for (const auto& [lower, upper] :
       {std::pair(0.8, 1.7), {0.01, 1.2}, {0.3, 100.0}, {1.4, 1.3}, {0.905, 0.92}}) {
    const auto judge = between(lower, upper);
    FailingByScale seen;
    long bound = most_scales({}, range);
    const FailingByScale all = search_window(range, [&](double scale) {
      const long now = most_scales(seen, range);
      CHECK(now <= bound);
      CHECK(now > std::ssize(seen));
      bound = now;
      return seen[scale] = judge(scale);
    });
    CHECK(std::ssize(all) <= most_scales(all, range));
    CHECK(most_scales(all, range) <= bound);
  }
}

TEST_CASE("the bound leaves out what lies beyond an end that is an edge's side, from the second "
          "look on") {
  const SearchRange range{0.5, 2, 13, 0.01, 0.0625, 16}, as_it_is{0.5, 2, 13, 0.01};
  const double second = first_scales(range)[1];
  const long one_cell = 63, cells = 6; // of a ratio of √2 each, down to 1 %
  CHECK(most_scales({}, range) > most_scales({}, as_it_is) + 12 * one_cell);
  const FailingByScale holds_further_in{{0.5, {0}}, {second, {}}};
  CHECK(most_scales({{0.5, {0}}}, range) == most_scales({}, range)); // it may fail everywhere
  CHECK(most_scales(holds_further_in, range) ==
        most_scales({{0.5, {0}}}, range) - cells * (one_cell + 1));
}

TEST_CASE("the widest window is that of the largest ratio of its ends", "[window]") {
  const auto window = [](double lower, double upper) {
    return Window{lower, upper, std::nullopt, std::nullopt};
  };
  const std::vector<Window> windows{window(0.3, 0.32), window(0.5, 1.0), window(2, 3.4),
                                    window(8, 10)};
  CHECK(widest(windows) == &windows[1]); // the differences grow: 0.02, 0.5, 1.4, 2
  CHECK(widest({}) == nullptr);
}
