#include "montecarlo/foundation/formats/printable.hpp"

#include <catch2/catch.hpp>

#include <string>

using namespace wingspread;

TEST_CASE("control characters are spelled out, and all other text is left alone") {
  CHECK(printable("a\x1b[31mb\x07\x7f\r") == R"(a\x1b[31mb\x07\x7f\x0d)");
  CHECK(printable("N·m ≤ 1\t2\n") == "N·m ≤ 1\t2\n");
  CHECK(printable("\xC2\x9B"
                  "31m") == R"(\xc2\x9b31m)"); // U+009B, which begins a sequence as ESC [ does
  CHECK(printable("\xC2\xA0") == "\xC2\xA0");  // U+00A0
}

TEST_CASE("bytes that are no UTF-8 are spelled out") {
  CHECK(printable("\xC2\xA0\xC2") == "\xC2\xA0\\xc2"); // half a character at the end
  CHECK(printable("a\xFF\xFE b") == R"(a\xff\xfe b)");
  CHECK(printable("\xE9t\xE9") == R"(\xe9t\xe9)");               // Latin 1
  CHECK(printable("\xC0\xAF") == R"(\xc0\xaf)");                 // overlong
  CHECK(printable("\xED\xA0\x80") == R"(\xed\xa0\x80)");         // half of a surrogate pair
  CHECK(printable("\xF4\x90\x80\x80") == R"(\xf4\x90\x80\x80)"); // above U+10FFFF
  CHECK(printable("\xE2\x82\xAC\xF0\x9F\x9B\xB0") ==
        "\xE2\x82\xAC\xF0\x9F\x9B\xB0"); // €, a satellite
}

TEST_CASE("a text has control characters or not") {
  CHECK(has_control_characters("a\nb"));
  CHECK(has_control_characters(std::string_view("\0", 1)));
  CHECK(has_control_characters("\xC2\x85"));
  CHECK_FALSE(has_control_characters("μ-root é"));
}

TEST_CASE("a word of a command is quoted where a shell would split, expand or lose it") {
  for (const char* plain : {"part_1/c-2.json", "root=0.5", "a@b:%+,"})
    CHECK(shell_word(plain) == plain);
  CHECK(shell_word("") == "''");
  for (const char* special : {"two halves", "$HOME", "a;b", "*", "~", "a\"b", "höhe"})
    CHECK(shell_word(special) == '\'' + std::string(special) + '\'');
  CHECK(shell_word("it's") == R"('it'\''s')");
}
