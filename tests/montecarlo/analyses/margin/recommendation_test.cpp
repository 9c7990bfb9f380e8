#include "montecarlo/analyses/margin/margin_findings.hpp"
#include "montecarlo/analyses/margin/recommendation.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cmath>

using namespace wingspread;

namespace {

constexpr long runs_of_look = 1000;

/// A requirement of which so many of 1000 runs break it, and 10 may.
Verdict verdict(double broken) {
  Verdict made;
  made.requirement.probability = 0.99;
  made.runs = runs_of_look;
  made.allowed = 10;
  for (long run = 0; run < std::lround(broken); ++run) made.broken.push_back(run);
  made.decision = made.broken.size() <= 10 ? Decision::pass : Decision::fail;
  return made;
}

/// A wing that weak springs do not deploy, and strong ones strike: so many runs at a scale.
struct Wing {
  double (*weak)(double), (*strong)(double);
  std::vector<double> scales;
  double short_below = 0; ///< of static margins
  int scales_run = 0;

  [[nodiscard]] ScaleResult at(double scale) const {
    return {CaseResult{{}, {verdict(weak(scale)), verdict(strong(scale))}}};
  }
  [[nodiscard]] MarginSearch recommended() {
    MarginSearch search;
    for (const double scale : scales) search.seen[scale] = at(scale);
    const auto run_at = [&](double scale) { search.seen[scale] = at(scale), ++scales_run; };
    const auto shortfall = [&](double scale) -> std::optional<Shortfall> {
      if (scale >= short_below) return std::nullopt;
      return Shortfall{scale, "root", MarginKind::ecss, scale - short_below, 1 - short_below};
    };
    recommend({0.01, run_at, shortfall}, search);
    return search;
  }
};

double line(double at, double zero, double slope) { return std::max(0.0, slope * (at - zero)); }

} // namespace

TEST_CASE("strain is what breaks over what may", "[margin]") {
  CHECK(strain(verdict(5)) == Approx(0.5).epsilon(1e-13));
  CHECK(strain({CaseResult{{}, {verdict(1), verdict(7)}}, CaseResult{{}, {verdict(3)}}}) ==
        Approx(0.7).epsilon(1e-13));
}

// Weak springs break 40 (1.2 − s) runs and strong ones 20 (s − 0.8): as many at s = 1.0667, and not in the middle of
// the window, √(0.95 · 1.3) = 1.11.
TEST_CASE("the scale is the one whose worse side is best, and is searched for", "[margin]") {
  Wing wing{[](double s) { return 40 * (1.2 - s) < 0 ? 0 : 40 * (1.2 - s); },
            [](double s) { return line(s, 0.8, 20); },
            {0.9, 0.95, 1.15, 1.3, 1.33}};
  wing.weak = [](double s) { return line(-s, -1.2, 40); };
  const MarginSearch search = wing.recommended();
  REQUIRE(search.recommended);
  CHECK(*search.recommended ==
        Approx(1.0667).epsilon(0.02)); // 5 of either: whole runs, 0.0125 and 0.025 apart
  CHECK(search.withheld == Withheld::nothing);
  CHECK(search.as_good.lower <= *search.recommended);
  CHECK(*search.recommended <= search.as_good.upper);
  CHECK_FALSE(search.passed_over);
  CHECK(wing.scales_run <= 20);
  CHECK(strain(search.seen.at(*search.recommended)) <= 0.6);
}

TEST_CASE("of several that are equally good the present springs are kept", "[margin]") {
  Wing wing{[](double s) { return line(-s, -0.7, 100); },
            [](double s) { return line(s, 1.1, 100); },
            {0.5, 0.6, 0.7, 0.8, 0.9, 1, 1.1, 1.2, 1.3}};
  const MarginSearch search = wing.recommended();
  CHECK(search.recommended == 1.0);
  CHECK(search.as_good.lower == Approx(0.695).epsilon(0.01)); // from there on half a run breaks it
  CHECK(search.as_good.upper == Approx(1.105).epsilon(0.01));
  CHECK(rule_of(search) == "present springs");
  CHECK(wing.scales_run <= 8);
}

TEST_CASE("where the present springs are not as good, the middle of what is", "[margin]") {
  Wing wing{[](double s) { return line(-s, -1.2, 100); },
            [](double s) { return line(s, 1.6, 100); },
            {1, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8}};
  const MarginSearch search = wing.recommended();
  CHECK(search.as_good.lower == Approx(1.195).epsilon(0.01));
  CHECK(search.as_good.upper == Approx(1.605).epsilon(0.01));
  CHECK(*search.recommended == Approx(std::sqrt(search.as_good.lower * search.as_good.upper))
                                   .epsilon(1e-3)); // rounded to few digits
  CHECK(rule_of(search) == "geometric mean");
  CHECK(why_this_one(search) ==
        fmt::format(
            ", nor at any other scale seen from {} to {}: their geometric mean is recommended",
            search.as_good.lower, search.as_good.upper));
}

TEST_CASE("where a range of scales is as good, the grid does not decide which is taken",
          "[margin]") {
  Wing wing{[](double s) { return line(-s, -1.2, 100); },
            [](double s) { return line(s, 1.6, 100); },
            {1, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8}};
  const double fine = *wing.recommended().recommended;
  wing.scales = {1, 1.12, 1.27, 1.44, 1.66, 1.8};
  CHECK(*wing.recommended().recommended == Approx(fine).epsilon(0.01));
}

TEST_CASE("a middle that fails splits the window, and the wider part is taken", "[margin]") {
  Wing wing{[](double s) { return s < 1.2 || (s > 1.38 && s < 1.4) ? 50.0 : 0.0; },
            [](double s) { return line(s, 1.6, 100); },
            {1, 1.2, 1.6, 1.7, 1.8}};
  const MarginSearch search = wing.recommended();
  REQUIRE(search.recommended);
  CHECK(failing(search.seen.at(*search.recommended)).empty());
}

// From 0.5 to 0.6 nothing breaks, nor from 1.4 to 1.6; between them 5 runs do. The first range is the wider one by ratio,
// the second by difference.
TEST_CASE("of two ranges that are as good the wider one by ratio is taken: scales upside down "
          "change nothing",
          "[margin]") {
  Wing wing{[](double s) { return s < 0.5              ? line(-s, -0.5, 500)
                                  : s > 0.6 && s < 1.4 ? 5.0
                                                       : 0.0; },
            [](double s) { return line(s, 1.6, 500); },
            {0.4, 0.5, 0.6, 1, 1.4, 1.6, 1.8}};
  const MarginSearch search = wing.recommended();
  REQUIRE(search.recommended);
  CHECK(*search.recommended == Approx(std::sqrt(0.5 * 0.6)).epsilon(0.02));
  Wing inverse{[](double t) { return 1 / t < 0.5 ? line(-1 / t, -0.5, 500) : 0.0; },
               [](double t) {
                 const double s = 1 / t;
                 return s > 0.6 && s < 1.4 ? 5.0 : line(s, 1.6, 500);
               },
               {}};
  for (const double scale : wing.scales) inverse.scales.push_back(1 / scale);
  const MarginSearch other = inverse.recommended();
  REQUIRE(other.recommended);
  CHECK(*other.recommended == Approx(1 / *search.recommended).epsilon(0.02));
}

TEST_CASE("without both edges nothing is recommended", "[margin]") {
  Wing wing{[](double) { return 0.0; },
            [](double s) { return line(s, 1.1, 100); },
            {0.5, 0.7, 1, 1.1, 1.3}};
  MarginSearch search = wing.recommended();
  CHECK_FALSE(search.recommended);
  CHECK(search.withheld == Withheld::no_lower_edge);
  wing.weak = [](double s) { return line(-s, -0.7, 100); };
  wing.strong = [](double) { return 0.0; };
  search = wing.recommended();
  CHECK_FALSE(search.recommended);
  CHECK(search.withheld == Withheld::no_upper_edge);
  wing.strong = [](double) { return 900.0; };
  CHECK(wing.recommended().withheld == Withheld::no_window);
  CHECK(wing.scales_run == 0);
}

// At 0.6 no run breaks anything and at 1 some do, but weaker springs would be short of torque at rest.
TEST_CASE("weaker springs that fall short at rest are passed over, and said", "[margin]") {
  Wing wing{[](double s) { return line(-s, -0.5, 100); },
            [](double s) { return line(s, 0.9, 50); },
            {0.3, 0.4, 0.5, 0.6, 0.8, 1, 1.1, 1.2},
            1};
  const MarginSearch search = wing.recommended();
  CHECK(search.recommended == 1.0);
  REQUIRE(search.passed_over);
  CHECK(search.passed_over->scale == 0.5);
  CHECK(to_string(*search.passed_over) == "ECSS margin of root -0.50, now +0.00");
  wing.strong = [](double s) { return line(s, 0.7, 100); }; // nothing but weaker springs will do
  wing.scales = {0.3, 0.4, 0.5, 0.6, 0.8, 0.9, 1, 1.1};
  const MarginSearch none = wing.recommended();
  CHECK_FALSE(none.recommended);
  CHECK(none.withheld == Withheld::short_of_torque);
  CHECK(none.passed_over);
}
