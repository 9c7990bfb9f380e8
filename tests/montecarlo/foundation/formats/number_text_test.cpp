#include "montecarlo/foundation/formats/number_text.hpp"

#include <catch2/catch.hpp>

#include <cstdint>
#include <limits>

using namespace wingspread;

TEST_CASE("a number is the whole of its text, and within its type", "[number_text]") {
  CHECK(parse_number<double>("-2.5e3") == -2500);
  CHECK(parse_number<long>("17") == 17);
  CHECK(parse_number<std::uint64_t>("18446744073709551615") ==
        std::numeric_limits<std::uint64_t>::max());
  for (const char* text : {"", " ", " 1", "1 ", "+1", "1x", "0x1", "1,5", "1e999", "--1"})
    CHECK_FALSE(parse_number<double>(text));
  for (const char* text : {"", "1.0", "1e3", "-1", "18446744073709551616"})
    CHECK_FALSE(parse_number<std::uint64_t>(text));
}
