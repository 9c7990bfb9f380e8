#include "montecarlo/foundation/formats/text_layout.hpp"

#include <catch2/catch.hpp>

#include <limits>
#include <numbers>
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

TEST_CASE("a name fills its column, or a line of its own before it", "[text_layout]") {
  CHECK(in_column("µm", 4) == "µm  ");
  CHECK(in_column("µµm", 4) == "µµm ");
  CHECK(in_column("hinge", 5) == "hinge\n     ");
  CHECK(right_aligned("·1", 4) == "  ·1");
  CHECK(right_aligned("1234", 4) == " 1234");
}

TEST_CASE("numbers in five digits", "[text_layout]") {
  CHECK(in_digits(2) == "2.0000");
  CHECK(in_digits(-123456) == "-1.2346e+05");
  CHECK(in_digits(12345) == "12345.0");
  CHECK(in_digits(std::numeric_limits<double>::quiet_NaN()) == "–");
}

TEST_CASE("angles and rates are printed as their author wrote them", "[text_layout]") {
  CHECK(as_written(5 * std::numbers::pi / 180, "rad/s") == "5 deg/s");
  CHECK(as_written(-12.5 * std::numbers::pi / 180, "rad") == "-12.5 deg");
  CHECK(as_written(1.5, "rad/s") == "1.5 rad/s"); // 85.943669… deg/s
  CHECK(as_written(0.1, "s") == "0.1 s");
  CHECK(as_written(56.49241451380835, "N·m") == "56.4924 N·m"); // "500 in*lbf"
  CHECK(as_written(-0.0254 / 3, "m") == "-0.00846667 m");
  CHECK(as_written(123456.789, "N") == "123456.789 N"); // written so
  CHECK(as_written(0.12345678901234, "rad") == "7.07355 deg");
  CHECK(as_written(3, "") == "3");
  // a value beside the limit gets the limit's unit
  CHECK(factor_as_written(5 * std::numbers::pi / 180, "rad/s") == 180 / std::numbers::pi);
  CHECK(factor_as_written(-12.5 * std::numbers::pi / 180, "rad") == 180 / std::numbers::pi);
  CHECK(factor_as_written(1.5, "rad/s") == 1);
  CHECK(factor_as_written(5 * std::numbers::pi / 180, "N·m") == 1);
}

TEST_CASE("text that goes on a line is broken at blanks, and no word is cut", "[text_layout]") {
  CHECK(wrapped("", 3).empty());
  CHECK(wrapped("a  b", 3) == "a b");
  const std::string word(60, 'w');
  CHECK(wrapped(word + " x " + word, 10) == word + " x\n" + std::string(10, ' ') + word);
  CHECK(wrapped(word + word, 10) == word + word);
}

TEST_CASE("long lines of a text go on below, deeper", "[text_layout]") {
  const std::string word(40, 'w'), short_line = "  a b\n";
  CHECK(wrapped_lines(short_line) == short_line);
  CHECK(wrapped_lines("  a  b\n") == "  a  b\n"); // as it is, its blanks too
  CHECK(wrapped_lines("  " + word + ' ' + word + ' ' + word + "\nend") ==
        "  " + word + ' ' + word + "\n      " + word + "\nend\n");
  const std::string columns = word + "   " + word + "   " + word + '\n';
  CHECK(wrapped_lines(columns) == columns);
}

TEST_CASE("bounds are rounded to the side on which they hold", "[text_layout]") {
  CHECK(percent_at_least(0.99729792) == "99.729 %");
  CHECK(percent_at_least(0.8609, 1) == "86.0 %");
  CHECK(percent_at_least(0.29) == "29.000 %"); // 100 · 0.29 is less by a rounding
  CHECK(percent_at_least(0.99999999) == "99.999 %");
  CHECK(percent_at_most(0.13901, 2) == "13.91 %");
  CHECK(percent_at_most(0.139, 2) == "13.90 %");
  CHECK(percent_at_most(1) == "100.000 %");
  CHECK(in_digits_towards(184.3826, 1) == "184.39");
  CHECK(in_digits_towards(184.3874, -1) == "184.38");
  CHECK(in_digits_towards(-1.00001, -1) == "-1.0001");
  CHECK(in_digits_towards(56.00000000000001, 1) == "56.000"); // a conversion's rounding
  CHECK(in_digits_towards(0, 1) == "0.0000");
  CHECK(in_digits_beside(184.3879, 184.388, 1) == "184.3879");
  CHECK(in_digits_beside(184.38826, 184.388, 1) == "184.39");
  CHECK(in_digits_beside(184.38826, 184.388, 0) == "184.39");
  CHECK(in_digits_beside(60.00000000000001, 60, 1) == "60.000");
  CHECK(in_digits_beside(2.00000004, 2, -1) == "2.00000004");
}

TEST_CASE("shares in percent, and counted things", "[text_layout]") {
  CHECK(percent(0.123456) == "12.346 %");
  CHECK(percent(0.126, 0) == "13 %");
  CHECK(percent(0.999999) == "99.9999 %"); // not 100
  CHECK(percent(0.99999, 3) == "99.999 %");
  CHECK(percent(0.9999, 1) == "99.99 %");
  CHECK(percent(1) == "100.000 %");
  CHECK(percent(std::numeric_limits<double>::quiet_NaN()) == "–");
  CHECK(percent_range(0.005, 0.5) == "0.500 – 50.000 %");
  CHECK(percent_range(0, 1) == "0.000 – 100.000 %");
  // bounds near 0 or 1 show their distance, and are rounded outwards: they hold the share between them
  CHECK(percent_range(0.9999997808181891, 0.9999999845331966) == "99.9999780 – 99.9999985 %");
  CHECK(percent_range(1.5466803339449127e-08, 2.1918181097213618e-07) == "0.0000015 – 0.0000220 %");
  CHECK(percent_range(0, 9.222198210040114e-08) == "0.0000000 – 0.0000093 %");
  CHECK(percent_range(0.99999907, 1) == "99.999907 – 100.000000 %");
  CHECK(spaced("timed_out") == "timed out");
  CHECK(counted(1, "body", "bodies") == "1 body");
  CHECK(counted(0, "body", "bodies") == "0 bodies");
}

TEST_CASE("bounds of any size are rounded to their side, and what is at its limit reads so") {
  CHECK(in_digits_towards(1.23456e-310, 1) == "1.2346e-310");
  CHECK(in_digits_towards(1.23454e-310, -1) == "1.2345e-310");
  CHECK_THAT(in_digits_towards(1.50001e308, 1), Catch::StartsWith("1.5001e+308"));
  CHECK(in_digits_beside(0.123456, 0.123456, 1) == "0.123456");
  CHECK(in_digits_beside(0.12345, 0.123456, 1) == "0.12345");
  CHECK(in_digits_beside(60, 60, -1) == "60.000");
}
