#include "montecarlo/foundation/formats/json_reader.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>

using namespace wingspread;

namespace {

template <class T> struct Read {
  bool done;
  T value;
  std::string problems;
};

/// Reads the value of {"x/y": …} into `value`.
template <class T, class Expected = std::string_view>
Read<T> read(const char* json, T value, Expected expected = "what I want") {
  Read<T> result{false, value, ""};
  result.problems = test::problems_of(parse_json(json), [&](const JsonCursor& at) {
    result.done = at.read(result.value, expected);
  });
  return result;
}

} // namespace

TEST_CASE("A value is described by its kind", "[json_reader]") {
  struct Case {
    const char *json, *words;
  };
  const auto [json, words] = GENERATE(values<Case>({{"null", "null"},
                                                    {"true", "true"},
                                                    {"-1.5", "-1.5"},
                                                    {"3", "3"},
                                                    {"\"a\\\"b\"", "string \"a\\\"b\""},
                                                    {"[1, 2]", "an array of 2"},
                                                    {"{\"a\": 1}", "an object"}}));
  CHECK(describe_value(parse_json(json)) == words);
}

TEST_CASE("A long string is shown by its beginning, cut between characters", "[json_reader]") {
  // The quote, 59 letters of 2 bytes, and the mark of what was cut: 61 characters.
  std::string letters;
  for (int i = 0; i < 59; ++i) letters += "ü";
  CHECK(describe_value(Json(letters + "üüü")) == "string \"" + letters + "…");
  CHECK(describe_value(Json(letters)) == "string \"" + letters + "\"");
}

TEST_CASE("Numbers are read, and nothing else as a number", "[json_reader]") {
  CHECK(read("2.5", 0.).value == 2.5);
  CHECK(read("-3", 0.).value == -3);
  for (const char* json : {"\"2\"", "true", "null", "[1]", "{}"}) {
    const auto [done, value, problems] = read(json, 7.);
    CHECK_FALSE(done);
    CHECK(value == 7);
    CHECK(problems == "found " + describe_value(parse_json(json)) + ", expected what I want");
  }
  std::vector<Problem> problems;
  double value = 7;
  const Json infinite = INFINITY; // the parser lets none through, but a program can make one
  CHECK_FALSE(JsonCursor(infinite, "", problems).read(value, "a number"));
  const Json none = NAN;
  CHECK_FALSE(JsonCursor(none, "", problems).read(value, "a number, kg, > 0"));
  CHECK(value == 7);
  CHECK(std::string(SpecError(problems).what()) == "found inf, expected a finite number\n"
                                                   "found nan, expected a finite number, kg, > 0");
}

TEST_CASE("A number with a dimension may be a string with its unit", "[json_reader]") {
  constexpr Dimension angle{"rad", "> 0"};
  CHECK(read("\"180 deg\"", 0., angle).value == 3.141592653589793);
  CHECK(read("3", 0., angle).value == 3);
  const auto [done, value, problems] = read("\"3 m\"", 7., angle);
  CHECK_FALSE(done);
  CHECK(value == 7);
  CHECK(problems ==
        "found string \"3 m\", expected a number, rad, > 0, or a string of a number and "
        "its unit: \"rad\", \"mrad\", \"deg\", \"°\" or \"rev\"");
  CHECK(read("true", 7., angle).problems == "found true, expected a number, rad, > 0");
}

TEST_CASE("Integers are read however JSON writes them", "[json_reader]") {
  CHECK(read("10000", std::int64_t{0}).value == 10000);
  CHECK(read("1e4", std::int64_t{0}).value == 10000);
  CHECK(read("-2.0", std::int64_t{0}).value == -2);
  CHECK(read("18446744073709551615", std::uint64_t{0}).value == 18446744073709551615u);
  CHECK(read("9007199254740992.0", std::uint64_t{0}).value == 9007199254740992u);
  for (const char* json : {"1.5", "18446744073709551615", "1e300", "\"1\"", "true"})
    CHECK(read(json, std::int64_t{0}).problems ==
          "found " + describe_value(parse_json(json)) + ", expected what I want");
  for (const char* json : {"-1", "-1.0", "0.5", "18446744073709551616"})
    CHECK_FALSE(read(json, std::uint64_t{0}).done);
}

TEST_CASE("Arrays name the element that is wrong", "[json_reader]") {
  constexpr Dimension metres{"m"};
  const Eigen::Vector2d zero(0, 0);
  CHECK(read("[1, \"20 mm\"]", zero, metres).value == Eigen::Vector2d(1, 0.02));
  CHECK(read("[1]", zero, metres).problems ==
        "found an array of 1, expected an array of 2 numbers, m");
  CHECK(read("3", zero, metres).problems == "found 3, expected an array of 2 numbers, m");
  CHECK(read("[null, \"x\"]", zero, metres).problems ==
        "/0: found null, expected a number, m\n"
        "/1: found string \"x\", expected a number, m, or a string of a number and its unit: "
        "\"m\", \"mm\", \"cm\", \"km\", \"in\" or \"ft\"");
  CHECK(read("[1, \"2 mm\"]", std::vector<double>{}, metres).value ==
        std::vector<double>{1, 0.002});
  CHECK(read("7", std::vector<double>{}, metres).problems ==
        "found 7, expected an array of numbers, m");
  CHECK(read("[1, 2.5, 3]", std::vector<double>{}).value == std::vector<double>{1, 2.5, 3});
  CHECK(read("{}", std::vector<double>{}).problems == "found an object, expected what I want");
  CHECK(read("[1, {}]", std::vector<double>{}).problems ==
        "/1: found an object, expected a number");
  CHECK(read("4", std::string("s")).problems == "found 4, expected what I want");
}

TEST_CASE("Words are chosen from a list", "[json_reader]") {
  constexpr std::array<std::string_view, 3> words{"fixed", "prescribed", "free"};
  const Json good = "free", unknown = "fre", number = 3;
  std::vector<Problem> problems;
  CHECK(JsonCursor(good, "", problems).choice(words) == 2u);
  CHECK_FALSE(JsonCursor(unknown, "", problems).choice(words));
  CHECK_FALSE(JsonCursor(number, "", problems).choice(words));
  CHECK(std::string(SpecError(problems).what()) ==
        "found string \"fre\", expected \"fixed\", \"prescribed\" or \"free\" (did you mean "
        "\"free\"?)\n"
        "found 3, expected \"fixed\", \"prescribed\" or \"free\"");
}

TEST_CASE("An object tells what is missing, what is unknown and what does not hold",
          "[json_reader]") {
  double mass = 1, inertia = 2, angle = 3;
  const auto positive = [](const double& number) { return number > 0; };
  const auto problems = [&](const char* json) {
    return test::problems_of(parse_json(json), [&](const JsonCursor& at) {
      JsonObject object(at, "a body");
      object.required("mass", mass, "a number, kg, > 0", positive);
      object.required("inertia", inertia, "a number, kg·m²");
      object.optional("angle", angle, "a number, rad");
      object.refuse_others();
    });
  };
  CHECK(problems(R"({"mass": 4, "inertia": 5})").empty());
  CHECK(mass == 4);
  CHECK(inertia == 5);
  CHECK(angle == 3);
  CHECK(problems("[]") == "found an array of 0, expected a body");
  CHECK(problems(R"({"mass": -4, "angel": 1, "a/b": 2})") ==
        "/mass: found -4, expected a number, kg, > 0\n"
        "/inertia: found nothing, expected a number, kg·m²\n"
        "/angel: found the unknown key \"angel\", expected \"mass\", \"inertia\" or \"angle\" (did "
        "you "
        "mean \"angle\"?)\n"
        "/a~1b: found the unknown key \"a/b\", expected \"mass\", \"inertia\" or \"angle\"");
  CHECK(mass == 4);
}
