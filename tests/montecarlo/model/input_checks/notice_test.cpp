#include "montecarlo/model/input_checks/notice.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE("a notice is one line, and one a place", "[notices]") {
  Notices notices({"wing.json", "/scene"});
  notices.add("/base", "a", "b");
  notices.add("/base", "c", "d");
  notices.add("/bodies/0", "e", "f");
  REQUIRE(notices.list().size() == 2);
  CHECK(to_string(notices.list()[0]) == "wing.json: /scene/base: found a, usual is b");
  CHECK(std::string(as_errors(notices.list()).what()) ==
        "wing.json: /scene/base: found a, expected b\nwing.json: /scene/bodies/0: found e, "
        "expected f");
}
