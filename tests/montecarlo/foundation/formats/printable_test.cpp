#include "montecarlo/foundation/formats/printable.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE("control characters are spelled out, and all other text is left alone") {
  CHECK(printable("a\x1b[31mb\x07\x7f\r") == R"(a\x1b[31mb\x07\x7f\x0d)");
  CHECK(printable("N·m ≤ 1\t2\n") == "N·m ≤ 1\t2\n");
  CHECK(printable("\xC2\x9B"
                  "31m") == R"(\xc2\x9b31m)"); // U+009B, which begins a sequence as ESC [ does
  CHECK(printable("\xC2\xA0\xC2") == "\xC2\xA0\xC2"); // U+00A0, and half a character
}

TEST_CASE("a text has control characters or not") {
  CHECK(has_control_characters("a\nb"));
  CHECK(has_control_characters(std::string_view("\0", 1)));
  CHECK(has_control_characters("\xC2\x85"));
  CHECK_FALSE(has_control_characters("μ-root é"));
}
