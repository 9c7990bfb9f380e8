#include "montecarlo/foundation/formats/csv.hpp"

#include <catch2/catch.hpp>

#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>

using namespace wingspread;

namespace {

using Records = std::vector<std::vector<std::string>>;

Records read(const std::string& text) {
  std::istringstream in(text);
  CsvReader reader(in, "some.csv");
  Records records;
  while (reader.next()) records.push_back(reader.cells());
  return records;
}

std::string cell(auto value) {
  std::string text;
  append_csv_cell(text, value);
  return text;
}

} // namespace

TEST_CASE("CSV cells are split at commas and records at line breaks") {
  CHECK(read("a,b\n1,2\n") == Records{{"a", "b"}, {"1", "2"}});
  CHECK(read("a,b\r\n1,2\r\n") == Records{{"a", "b"}, {"1", "2"}});
  CHECK(read("a,b\n1,2") == Records{{"a", "b"}, {"1", "2"}});
  CHECK(read(",\n") == Records{{"", ""}});
  CHECK(read("\n") == Records{{""}});
  CHECK(read("") == Records{});
  CHECK(read("\xEF\xBB\xBF"
             "a\n") == Records{{"a"}});
}

TEST_CASE("CSV quotes hold commas, quotes and line breaks") {
  CHECK(read("\"a,b\",\"say \"\"go\"\"\",\"two\nlines\",\"\"\n") ==
        Records{{"a,b", "say \"go\"", "two\nlines", ""}});
}

TEST_CASE("any text survives a CSV cell") {
  std::mt19937_64 random(11);
  const std::string alphabet = "a,\"\r\n\xC3\xA9 >";
  for (int round = 0; round < 2000; ++round) {
    std::vector<std::string> cells(1 + random() % 4);
    std::string line;
    for (std::string& each : cells) {
      for (auto length = random() % 6; length > 0; --length)
        each += alphabet[random() % alphabet.size()];
      line += (line.empty() ? "" : ",");
      append_csv_cell(line, each);
      // A lone first empty cell would leave `line` empty and lose its comma.
      if (line.empty()) line = "\"\"";
    }
    INFO(line);
    CHECK(read(line + "\n") == Records{cells});
  }
}

TEST_CASE("CSV numbers have 17 significant digits and read back to the same bits") {
  CHECK(cell(0.1) == "0.10000000000000001"); // printf("%.17g", 0.1)
  CHECK(cell(1.0) == "1");
  CHECK(cell(-0.0) == "-0");
  CHECK(cell(1e-7) == "9.9999999999999995e-08");
  CHECK(cell(1e22) == "1e+22");
  std::mt19937_64 random(7);
  for (int round = 0; round < 20000; ++round) {
    const auto value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    const std::string text = cell(value);
    double back = 0;
    std::from_chars(text.data(), text.data() + text.size(), back);
    REQUIRE(std::bit_cast<std::uint64_t>(back) == std::bit_cast<std::uint64_t>(value));
  }
}

TEST_CASE("what is not finite is an empty CSV cell") {
  CHECK(cell(std::numeric_limits<double>::quiet_NaN()).empty());
  CHECK(cell(std::numeric_limits<double>::infinity()).empty());
}

TEST_CASE("cells of any kind follow the first one of a record", "[csv]") {
  std::string record = "7";
  append_csv_cells(record, 0.5, "a, b", -3L, std::optional<double>{}, std::optional(2.),
                   std::size_t{9});
  CHECK(record == "7,0.5,\"a, b\",-3,,2,9");
  CHECK(csv_cell(0.1) == "0.10000000000000001");
}

TEST_CASE("the reader knows lines, bytes and whether a record was ended") {
  std::istringstream in("a,\"b\nc\"\r\nd\ne");
  CsvReader reader(in, "some.csv");
  REQUIRE(reader.next());
  CHECK((reader.line() == 1 && reader.bytes() == 9 && reader.terminated()));
  REQUIRE(reader.next());
  CHECK((reader.line() == 3 && reader.bytes() == 11 && reader.terminated()));
  REQUIRE(reader.next());
  CHECK((reader.line() == 4 && reader.bytes() == 12 && !reader.terminated()));
  CHECK_FALSE(reader.next());
}

TEST_CASE("CSV faults name the file, the line, what was found and what was expected") {
  CHECK_THROWS_WITH(read("a\nb\"c\"\n"),
                    "some.csv: line 2: found a quote inside the cell 'b\"c\"', "
                    "expected quotes around the whole cell");
  CHECK_THROWS_WITH(
      read("\"a\"b\n"),
      "some.csv: line 1: found 'b' after a closing quote, expected a comma or a line break");
  CHECK_THROWS_WITH(
      read("a\n\"b\n"),
      "some.csv: line 2: found a quote that is never closed, expected a closing quote");
  CHECK_THROWS_WITH(read("a\rb\n"), "some.csv: line 1: found a carriage return on its own, "
                                    "expected lines that end in LF or CRLF");
}

TEST_CASE("a header's unit stands in the brackets that end it, other brackets and all") {
  const auto split = [](const std::string& header) {
    const HeaderCell cell = header_cell(header);
    return cell.name + "|" + cell.unit;
  };
  CHECK(split(" c [N·m/(rad/s)] ") == "c|N·m/(rad/s)");
  CHECK(split("c (in*lbf/(rad/s))") == "c|in*lbf/(rad/s)");
  CHECK(split("c (a) [((m))/s]") == "c (a)|((m))/s");
  CHECK(split("(deg)") == "|deg");
  CHECK(split("m]") == "m]|");
  CHECK(split("a [m] b") == "a [m] b|");
  CHECK(split("") == "|");
}
