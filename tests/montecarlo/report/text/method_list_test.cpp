#include "montecarlo/foundation/formats/json_parse.hpp"
#include "montecarlo/report/text/method_list.hpp"

#include <catch2/catch.hpp>

#include <limits>

using namespace wingspread;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::vector<MethodInfo> some_methods() {
  std::vector<MethodInfo> list(3);
  list[0] = {"auto", "chooses by itself", 0, 0, 0, "", "the default"};
  list[1] = {
      "runge_kutta4", "explicit Runge-Kutta, fixed step", 4, 2.785, 2.828, "cubic Hermite", ""};
  list[2] = {"implicit", "Rosenbrock", 3, infinity, 0.5, "quintic", "stiff"};
  return list;
}

} // namespace

TEST_CASE("the methods as a table, and a note on each") {
  const std::string text = methods_text(some_methods());
  CHECK_THAT(text, Catch::StartsWith(
                       "METHOD                    order      real  imaginary   kind\n"
                       "auto                          –         –          –   chooses by itself\n"
                       "runge_kutta4                  4     2.785      2.828   explicit "
                       "Runge-Kutta, fixed step\n"
                       "implicit                      3         ∞        0.5   Rosenbrock\n"));
  CHECK_THAT(text, Catch::Contains("\nauto\n  the default\n") &&
                       Catch::Contains("\nrunge_kutta4\n  within a step: cubic Hermite\n") &&
                       Catch::EndsWith("\nimplicit\n  stiff\n  within a step: quintic\n"));
}

TEST_CASE("long remarks are broken at blanks, by characters and not by bytes") {
  std::vector<MethodInfo> methods(1);
  for (int i = 0; i < 30; ++i) methods[0].note += (i == 0 ? "" : " ") + std::string("∞∞∞∞∞∞");
  const std::string text = methods_text(methods);
  const auto infinities = [](int words) {
    std::string line = " ";
    for (int i = 0; i < words; ++i) line += " ∞∞∞∞∞∞";
    return line + "\n";
  };
  CHECK_THAT(text, Catch::EndsWith("\n\n" + infinities(14) + infinities(14) + infinities(2)));
}

TEST_CASE("the methods as strict JSON") {
  const Json json = methods_json(some_methods());
  REQUIRE(json.size() == 3);
  CHECK(json[0].dump() ==
        R"({"name":"auto","kind":"chooses by itself","order":null,"real_limit":null,)"
        R"("imaginary_limit":null,"interpolation":"","note":"the default"})");
  CHECK(json[1]["order"] == 4);
  CHECK(json[1]["imaginary_limit"] == 2.828);
  CHECK(json[2]["real_limit"].get<std::string>() == "unbounded");
}
