#include "montecarlo/foundation/formats/json.hpp"

#include <catch2/catch.hpp>

#include <limits>

using namespace wingspread;

TEST_CASE("what is not finite, or not there, is null in JSON", "[json]") {
  CHECK(json_number(0.1).dump() == "0.1");
  CHECK(json_number(std::numeric_limits<double>::quiet_NaN()).is_null());
  CHECK(json_number(-std::numeric_limits<double>::infinity()).is_null());
  CHECK(json_number(std::optional(2.5)) == 2.5);
  CHECK(json_number(std::optional<double>{}).is_null());
}

TEST_CASE("the text of a JSON file is indented, and ends with its line", "[json]") {
  CHECK(json_text({{"b", {1, 2}}, {"a", Json::object()}}) ==
        "{\n  \"b\": [\n    1,\n    2\n  ],\n  \"a\": {}\n}\n");
}

TEST_CASE("bytes that are not UTF-8 do not stop a JSON file", "[json]") {
  CHECK(json_text(Json("a\xFFz")) == "\"a\xEF\xBF\xBDz\"\n");
}
