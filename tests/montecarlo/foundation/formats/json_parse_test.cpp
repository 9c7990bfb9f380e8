#include "montecarlo/foundation/formats/json_parse.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

#include <filesystem>

using namespace wingspread;

TEST_CASE("Whatever is not strict JSON is refused with its place", "[json_parse]") {
  struct Case {
    const char *text, *message;
  };
  const auto [text, message] = GENERATE(values<Case>(
      {{"", "f.json: found line 1, column 1: syntax error while parsing value - unexpected end of "
            "input, expected '[', '{', or a literal"},
       {"{\n  \"a\": 1,\n}",
        "f.json: found line 3, column 1: syntax error while parsing object key - "
        "unexpected '}', expected string literal"},
       {"{} x",
        "f.json: found line 1, column 4: syntax error while parsing value - invalid literal; "
        "last read: '{} x', expected end of input"},
       {"[NaN]",
        "f.json: found line 1, column 2: syntax error while parsing value - invalid literal; "
        "last read: '[N', expected valid JSON"},
       {"[Infinity]", "f.json: found line 1, column 2: syntax error while parsing value - invalid "
                      "literal; last read: '[I', expected valid JSON"},
       {"[-Infinity]", "f.json: found line 1, column 3: syntax error while parsing value - invalid "
                       "number, expected digit after '-'; last read: '-I'"},
       {"// no\n1", "f.json: found line 1, column 1: syntax error while parsing value - invalid "
                    "literal; last read: '/', expected valid JSON"},
       {"[1, {\"a\": [0, 1e999]}]",
        "f.json: /1/a/1: found the number 1e999, expected a number within the range of a double"},
       {"[\n{\"a\":\n  {\"b\": 1 \"c\"}}]",
        "f.json: found line 3, column 13: syntax error while parsing object - unexpected string "
        "literal, expected '}'"},
       {"[1,\n2\n", "f.json: found line 3, column 1: syntax error while parsing array - unexpected "
                    "end of input, expected ']'"},
       {"{\"a\": [1e999], \"b\": }",
        "f.json: /a/0: found the number 1e999, expected a number within the range of a double"},
       {"-1e400",
        "f.json: found the number -1e400, expected a number within the range of a double"}}));
  CAPTURE(text);
  CHECK(test::facts_of(test::message_of([&] { return parse_json(text, "f.json"); })) ==
        test::facts_of(message));
}

TEST_CASE("Brackets stand within each other to a depth that nobody writes", "[json_parse]") {
  const auto nested = [](std::size_t levels) {
    return std::string(levels, '[') + std::string(levels, ']');
  };
  CHECK_NOTHROW(parse_json(nested(64)));
  std::string place;
  for (int level = 0; level < 64; ++level) place += "/0";
  CHECK(test::message_of([&] { return parse_json(nested(65)); }) ==
        place + ": found one more level of brackets, expected at most 64");
  CHECK_THAT(test::message_of(
                 [&] { return parse_json(R"({"dispersions": )" + std::string(300'000, '[')); }),
             Catch::EndsWith("found one more level of brackets, expected at most 64"));
}

TEST_CASE("A text that is too long for a person's hand is not read", "[json_parse]") {
  const test::Folder folder;
  const auto path = folder.write("long.json", "");
  std::filesystem::resize_file(path, most_text_bytes + 1);
  CHECK(test::message_of([&] { return parse_json_file(path); }) ==
        path.string() + ": found 67108865 bytes, expected at most 67108864");
}

TEST_CASE("Every key that stands twice in one object is refused", "[json_parse]") {
  const char* text = R"({"a": [[], {}, {"b/~": 1, "b/~": {}}], "c": {"a": 0}, "a": 2})";
  CHECK(test::message_of([&] { return parse_json(text); }) ==
        "/a/2/b~1~0: found the key \"b/~\" a second time, expected the key once\n"
        "/a: found the key \"a\" a second time, expected the key once");
  CHECK_NOTHROW(parse_json(R"([{"a": 1}, {"a": {"a": 2}}])"));
}

TEST_CASE("Parsing keeps values and the order of keys", "[json_parse]") {
  CHECK(parse_json(R"( {"b": [1, -2.5e3, true, null], "a": "ü\n"} )").dump() ==
        "{\"b\":[1,-2500.0,true,null],\"a\":\"ü\\n\"}");
}

TEST_CASE("A file that cannot be read is a problem of its own", "[json_parse]") {
  CHECK(test::message_of([] { return parse_json_file("no/such.json"); }) ==
        "no/such.json: found no file that can be read, expected a JSON file");
  const std::string folder = std::filesystem::temp_directory_path().string();
  CHECK(test::message_of([&] { return parse_json_file(folder); }) ==
        folder + ": found no file that can be read, expected a JSON file");
}

TEST_CASE("A NUL byte behind a document does not end it", "[json_parse]") {
  const auto message_of = [](const std::string& text) {
    try {
      (void)parse_json(text, "f.json");
    } catch (const SpecError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  for (const char* rest : {"", "{ garbage", "\n"}) {
    const std::string text = std::string("{\n}") + '\0' + rest;
    CHECK(message_of(text) == "f.json: found line 2, column 2: a NUL byte, expected JSON text");
  }
  CHECK(message_of("{\n}").empty());
}
