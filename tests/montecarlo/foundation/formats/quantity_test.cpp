#include "montecarlo/foundation/formats/quantity.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE("A number with its unit becomes the SI number, to the last bit", "[quantity]") {
  struct Case {
    const char *text, *unit;
    double value;
  };
  // The values are the definitions: in = 0.0254 m, lb = 0.45359237 kg, g = 9.80665 m/s², lbf = lb g, min = 60 s.
  const auto [text, unit, value] = GENERATE(values<Case>({
      {"90 deg", "rad", 1.5707963267948966},
      {"180deg", "rad", 3.141592653589793},
      {"-90 °", "rad", -1.5707963267948966},
      {"1 rev", "rad", 6.283185307179586},
      {"5 mrad", "rad", 0.005},
      {"0.5 rad", "rad", 0.5},
      {"2 deg/s", "rad/s", 0.03490658503988659},
      {"60 rpm", "rad/s", 6.283185307179586},
      {"90 deg/s^2", "rad/s²", 1.5707963267948966},
      {"350 mm", "m", 0.35},
      {"12 in", "m", 0.3048},
      {"1 ft", "m", 0.3048},
      {"2.5e-3 km", "m", 2.5},
      {"100 cm/s", "m/s", 1},
      {"2 min", "s", 120},
      {"250 ms", "s", 0.25},
      {"10 lb", "kg", 4.5359237},
      {"500 g", "kg", 0.5},
      {"1 g", "m/s²", 9.80665},
      {"0.001 g*m^2", "kg·m²", 1e-6},
      {"3 N", "N", 3},
      {"1 lbf", "N", 4.4482216152605},
      {"12 in*lbf", "N·m", 1.3558179483314004},
      {"1 ft*lbf", "N·m", 1.3558179483314004},
      {"16 in*ozf", "N·m", 0.1129848290276167},
      {"250 N*mm", "N·m", 0.25},
      {"2 N·m", "N·m", 2},
      {"2 Nm", "N·m", 2},
      {"2 kN*m", "N·m", 2000},
      {"2 kg*m²/s²*rad^0", "N·m", 2},
      {"1e6 kg*mm^2", "kg·m²", 1},
      {"1 slug", "kg", 14.593902937206364},
      {"10 N*m/rad", "N·m/rad", 10},
      {"3.14159265358979323846 N*m/deg", "N·m/rad", 180},
      {"1 N*m/(rad/s)", "N·m·s/rad", 1},
      {"1 N·m·s/rad", "N·m·s/rad", 1},
      {"1 N*mm*s/rad", "N·m·s/rad", 0.001},
      {"1200 g/m³", "kg/m³", 1.2},
      {"2 s/rad", "s/rad", 2},
      {"3 N*m*(s/rad)^0.45", "N·m·(s/rad)^0.45", 3},
      {"0 mm", "m", 0},
  }));
  CAPTURE(text);
  REQUIRE(in_unit(text, unit));
  CHECK(*in_unit(text, unit) == value);
}

TEST_CASE("What is no number with a unit of the dimension is nothing", "[quantity]") {
  struct Case {
    const char *text, *unit;
  };
  const auto [text, unit] = GENERATE(values<Case>({
      {"", "m"},
      {"m", "m"},
      {"3", "m"},
      {"3 kg", "m"},
      {"3  m", "m"},
      {" 3 m", "m"},
      {"3 m ", "m"},
      {"3 metres", "m"},
      {"3 m*", "m"},
      {"3 /m", "m"},
      {"3 m^", "m"},
      {"3 m^2", "m"},
      {"3 (m", "m"},
      {"3 m)", "m"},
      {"3 ()", "m"},
      {"inf m", "m"},
      {"nan m", "m"},
      {"1e999 m", "m"},
      {"1e308 km", "m"},
      {"3 N*m", "N·m/rad"},
      {"3 N*m/rad", "N·m"},
      {"3 g", "s"},
      {"3 1/s", "rad/s"},
      {"3 m^1e9", "m"},
      {"3 ((((((((((m))))))))))", "m"},
      {"3 m", "no unit"},
      {"3 m", ""},
  }));
  CAPTURE(text);
  CHECK_FALSE(in_unit(text, unit));
}

TEST_CASE("A message names the units of a dimension", "[quantity]") {
  CHECK(units_like("kg") == "\"kg\", \"g\", \"lb\", \"lbm\" or \"slug\"");
  CHECK(units_like("s/rad") == "\"s/rad\" or \"s/deg\", or another one made of s, ms, min, h, rad, "
                               "mrad, deg, °, rev");
  CHECK(units_like("J") == "\"J\", \"mJ\", \"kJ\" or \"N*m\"");
  CHECK(units_like("N·m").ends_with(
      "\"ft*lbf\", or another one made of Nm, N, mN, kN, lbf, ozf, m, mm, cm, km, in, ft"));
  CHECK(units_like("N·m·(s/rad)^0.5").starts_with("\"N·m·(s/rad)^0.5\", or another one made of "));
  CHECK(units_like("no unit") == "\"no unit\"");
  CHECK(expected_number({"rad"}) == "a number, rad");
  CHECK(expected_number({"kg", "> 0"}) == "a number, kg, > 0");
  CHECK(expected_quantity({"kg", "> 0"}) == "a number, kg, > 0, or a string of a number and its "
                                            "unit: \"kg\", \"g\", \"lb\", \"lbm\" or \"slug\"");
  CHECK(expected_number({"", "> 0"}) == "a number, > 0");
  CHECK(expected_quantity({""}) == "a number");
  CHECK(expected_numbers({""}) == "an array of numbers");
  CHECK(expected_numbers({"m"}) == "an array of numbers, m");
  CHECK(expected_numbers({"m"}, 2) == "an array of 2 numbers, m");
}

TEST_CASE("Every unit that a message names is one", "[quantity]") {
  for (const char* unit :
       {"m", "kg", "s", "rad", "rad/s", "rad/s²", "s/rad", "m/s", "m/s²", "kg·m²", "Hz", "N·m²",
        "kg/m³", "N", "N·m", "N·m/rad", "N·m·s/rad", "J"}) {
    const std::string list = units_like(unit);
    for (std::size_t quote = list.find('"'); quote != std::string::npos;) {
      const std::size_t end = list.find('"', quote + 1);
      const std::string named = list.substr(quote + 1, end - quote - 1);
      CAPTURE(unit, named);
      CHECK(in_unit("1 " + named, unit));
      quote = list.find('"', end + 1);
    }
  }
}

// The symbols of the page on quantities, each with an SI unit that it can stand for.
TEST_CASE("Every symbol is named where it is accepted", "[quantity]") {
  const auto [symbol, unit] = GENERATE(table<const char*, const char*>({{"km", "m"},
                                                                        {"lbm", "kg"},
                                                                        {"slug", "kg"},
                                                                        {"h", "s"},
                                                                        {"°", "rad"},
                                                                        {"rev", "rad"},
                                                                        {"rpm", "rad/s"},
                                                                        {"mHz", "Hz"},
                                                                        {"mN", "N"},
                                                                        {"ozf", "N·m"},
                                                                        {"Nm", "N·m"},
                                                                        {"h", "rad/s"},
                                                                        {"km", "N·m²"},
                                                                        {"lbm", "kg·m²"},
                                                                        {"mJ", "J"}}));
  CAPTURE(symbol, unit);
  CHECK(units_like(unit).find(symbol) != std::string::npos);
}
