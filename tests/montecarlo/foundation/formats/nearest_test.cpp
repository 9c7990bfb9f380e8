#include "montecarlo/foundation/formats/nearest.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <random>

using namespace wingspread;

TEST_CASE("The edit distance counts insertions, deletions, substitutions and swaps of neighbours",
          "[nearest]") {
  struct Case {
    const char *a, *b;
    std::size_t distance;
  };
  const auto [a, b, distance] =
      GENERATE(values<Case>({{"", "", 0},
                             {"mass", "mass", 0},
                             {"mass", "mas", 1},
                             {"", "abc", 3},
                             {"mass", "moss", 1},
                             {"rnu", "run", 1},
                             {"ca", "abc", 3}, // 2 if a swapped pair could be torn apart again
                             {"kitten", "sitting", 3}})); // the textbook pair
  CAPTURE(a, b);
  CHECK(edit_distance(a, b) == distance);
  CHECK(edit_distance(b, a) == distance);
}

TEST_CASE("The nearest word is suggested only when it is near", "[nearest]") {
  const std::vector<std::string> known{"mass", "inertia", "mast"};
  CHECK(nearest("masss", known) == "mass");
  CHECK(nearest("rnu", {"new", "run"}) == "run");
  CHECK(nearest("innertia", known) == "inertia");
  CHECK(nearest("stiffness", known).empty());
  CHECK(nearest("", known).empty());
  CHECK(nearest("mass", {}).empty());
  CHECK(did_you_mean("inertio", known) == " (did you mean \"inertia\"?)");
  CHECK(did_you_mean("x", known).empty());
}

TEST_CASE("A word is near if half of its letters or more need no edit", "[nearest]") {
  std::mt19937_64 random(3);
  const auto word = [&] {
    std::string letters(1 + random() % 6, ' ');
    for (char& letter : letters) letter = static_cast<char>('a' + random() % 3);
    return letters;
  };
  int half = 0, suggested = 0;
  for (int k = 0; k < 3000; ++k) {
    const std::string asked = word(), known = word();
    const std::size_t distance = edit_distance(asked, known),
                      length = std::max(asked.size(), known.size());
    CAPTURE(asked, known);
    CHECK(nearest(asked, {known}) == (2 * distance <= length ? known : ""));
    half += 2 * distance == length;
    suggested += 2 * distance <= length;
  }
  CHECK((half > 100 && suggested > 500 && suggested < 2500));
}
