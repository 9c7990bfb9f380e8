#include "montecarlo/model/input_checks/input_warning.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE("a warning is one line, and one a place", "[warnings]") {
  InputWarnings warnings({"wing.json", "/scene"});
  warnings.add("/base", "a", "b");
  warnings.add("/base", "c", "d");
  warnings.add("/bodies/0", "e", "f");
  REQUIRE(warnings.list().size() == 2);
  CHECK(to_string(warnings.list()[0]) == "wing.json: /scene/base: found a, usual is b");
  CHECK(std::string(as_errors(warnings.list()).what()) ==
        "wing.json: /scene/base: found a, expected b\nwing.json: /scene/bodies/0: found e, "
        "expected f");
}
