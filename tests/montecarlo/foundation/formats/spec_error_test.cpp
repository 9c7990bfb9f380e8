#include "montecarlo/foundation/formats/spec_error.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace wingspread;

TEST_CASE("A problem is told on one line, less what it lacks", "[spec_error]") {
  CHECK(to_string({"a.json", "/runs", "-1", "an integer, ≥ 1"}) ==
        "a.json: /runs: found -1, expected an integer, ≥ 1");
  CHECK(to_string({"a.json", "", "nothing", "JSON"}) == "a.json: found nothing, expected JSON");
  CHECK(to_string({"", "/runs", "-1", "more"}) == "/runs: found -1, expected more");
}

TEST_CASE("Of very many problems a SpecError tells the first hundred", "[spec_error]") {
  const SpecError error(std::vector<Problem>(250, {"", "/a", "1", "2"}));
  const std::string message = error.what();
  CHECK(std::count(message.begin(), message.end(), '\n') == 100);
  CHECK(message.ends_with("/a: found 1, expected 2\nand 150 more problems"));
  CHECK(error.problems().size() == 250);
}

TEST_CASE("A SpecError tells all of its problems and keeps them apart", "[spec_error]") {
  const SpecError error({{"", "/a", "1", "2"}, {"", "/b", "3", "4"}});
  CHECK(std::string(error.what()) == "/a: found 1, expected 2\n/b: found 3, expected 4");
  REQUIRE(error.problems().size() == 2);
  CHECK(error.problems()[1].pointer == "/b");
}
