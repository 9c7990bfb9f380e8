#include "montecarlo/formats/text_layout.hpp"

#include <catch2/catch.hpp>

#include <limits>
#include <sstream>

using namespace wingspread;

TEST_CASE("characters are counted, not bytes", "[text_layout]") {
  CHECK(count_characters("") == 0);
  CHECK(count_characters("N·m ≤ 5 µs") == 10);
  CHECK(count_characters("𝛼β") == 2);
}

TEST_CASE("what is too long is cut between characters, and says so", "[text_layout]") {
  CHECK(shortened("hinge", 5) == "hinge");
  CHECK(shortened("hinges", 5) == "hing…");
  CHECK(shortened("äöüß€", 5) == "äöüß€");
  CHECK(shortened("äöüß€…", 5) == "äöüß…");
  CHECK(shortened("aé", 1) == "…");
}

TEST_CASE("a paragraph is broken at blanks, within the width of a table", "[text_layout]") {
  CHECK(paragraph("").empty());
  CHECK(paragraph("two  words\n") == "  two words\n");
  CHECK(paragraph("a b", 98) == std::string(98, ' ') + "a\n" + std::string(98, ' ') + "b\n");
  std::string long_text;
  for (int i = 0; i < 49; ++i) long_text += "µ ";
  const std::string full = "  " + long_text.substr(0, long_text.size() - 1) + '\n';
  CHECK(count_characters(full) == 100); // 99 and the line feed
  CHECK(paragraph(long_text) == full);
  CHECK(paragraph(long_text + "x").ends_with("µ\n  x\n")); // x would stand in column 101
}

TEST_CASE("shares in percent, and counted things", "[text_layout]") {
  CHECK(percent(0.123456) == "12.346 %");
  CHECK(percent(0.126, 0) == "13 %");
  CHECK(percent(std::numeric_limits<double>::quiet_NaN()) == "–");
  CHECK(percent_range(0.005, 0.5) == "0.500 – 50.000 %");
  CHECK(spaced("timed_out") == "timed out");
  CHECK(counted(1, "body", "bodies") == "1 body");
  CHECK(counted(0, "body", "bodies") == "0 bodies");
}
