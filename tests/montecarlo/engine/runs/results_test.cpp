#include "montecarlo/engine/runs/results.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>

using namespace wingspread;
using namespace wingspread::test;

namespace {

const ResultNames names{{"k", "mass, panel"}, {"root.latch_time", "deployment_time"}};

ResultsFile read(const std::string& text, const ResultNames& columns,
                 UnterminatedRow last = UnterminatedRow::read) {
  std::istringstream in(text);
  return read_results(in, "runs.csv", columns, last);
}

/// Reads a table of one draw, k, and one output, t.
Results read_small(const std::string& text) { return read(text, {{"k"}, {"t"}}).results; }

std::string write(const Results& results, const ResultNames& columns) {
  std::string text;
  append_header(text, columns);
  for (std::size_t row = 0; row < results.size(); ++row) append_row(text, results.row(row));
  return text;
}

double finite_bits(std::mt19937_64& random) {
  for (;;)
    if (const auto value = std::bit_cast<double>(random()); std::isfinite(value)) return value;
}

Results random_results(std::uint64_t seed, int rows) {
  std::mt19937_64 random(seed);
  const std::vector<std::string> texts{"", "root>mid>tip", "a \"b\", c", "µ; d"};
  Results results(names);
  for (long run = 0; run < rows; ++run) {
    ResultRow row{run,
                  statuses[random() % statuses.size()],
                  {},
                  {},
                  texts[random() % 2],
                  texts[random() % 4]};
    row.draws = {finite_bits(random), finite_bits(random)};
    row.outputs = {random() % 3 == 0 ? none : finite_bits(random), finite_bits(random)};
    results.append(row);
  }
  return results;
}

bool same_bits(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) ||
         std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

void check_same(const Results& a, const Results& b, std::size_t rows) {
  REQUIRE((a.size() >= rows && b.size() == rows));
  for (std::size_t i = 0; i < rows; ++i) {
    const ResultRow x = a.row(i), y = b.row(i);
    REQUIRE((x.run == y.run && x.status == y.status && x.latch_order == y.latch_order &&
             x.reason == y.reason));
    REQUIRE(std::ranges::equal(x.draws, y.draws, same_bits));
    REQUIRE(std::ranges::equal(x.outputs, y.outputs, same_bits));
  }
}

const std::string good_header = "run,status,k,t,latch_order,reason\n";

} // namespace

TEST_CASE("runs.csv is written as the formats say") {
  Results results(names);
  results.append({0, Status::deployed, {0.1, 10}, {2.5, 3}, "root>tip", ""});
  results.append(
      {1, Status::stalled, {-0.25, 9.5}, {none, none}, "", "friction holds, at \"mid\""});
  CHECK(write(results, names) ==
        "run,status,k,\"mass, panel\",root.latch_time,deployment_time,latch_order,reason\n"
        "0,deployed,0.10000000000000001,10,2.5,3,root>tip,\n"
        "1,stalled,-0.25,9.5,,,,\"friction holds, at \"\"mid\"\"\"\n");
}

TEST_CASE("runs.csv comes back bit for bit") {
  const Results results = random_results(1, 500);
  const std::string text = write(results, names);
  const ResultsFile back = read(text, names);
  check_same(results, back.results, results.size());
  CHECK(back.complete_bytes == text.size());
  CHECK_FALSE(back.unterminated);
  CHECK(write(back.results, names) == text);
}

TEST_CASE(
    "wherever a crash cuts runs.csv off, its complete rows are kept and resuming completes it") {
  const Results results = random_results(2, 12);
  const std::string text = write(results, names);
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    const ResultsFile left = read(text.substr(0, cut), names, UnterminatedRow::drop);
    REQUIRE(left.complete_bytes <= cut);
    REQUIRE(left.unterminated == (left.complete_bytes < cut));
    check_same(results, left.results, left.results.size());
    std::string resumed = text.substr(0, left.complete_bytes);
    if (left.complete_bytes == 0) append_header(resumed, names);
    for (std::size_t row = left.results.size(); row < results.size(); ++row)
      append_row(resumed, results.row(row));
    REQUIRE(resumed == text);
  }
}

TEST_CASE(
    "runs.csv of other tools: any column order, CRLF, quotes, no reason, no last line break") {
  const Results results = read_small(
      "latch_order,t,\"status\",run,k\r\nroot,2.5,deployed,3,1e0\r\n,,\"timed_out\",7,-.5");
  REQUIRE(results.size() == 2);
  CHECK(results.runs == std::vector<long>{3, 7});
  CHECK(results.status == std::vector{Status::deployed, Status::timed_out});
  CHECK(results.draws[0].values == std::vector{1.0, -0.5});
  CHECK(results.outputs[0].values[0] == 2.5);
  CHECK(std::isnan(results.outputs[0].values[1]));
  CHECK((results.latch_order[0] == "root" && results.latch_order[1].empty()));
  CHECK((results.reason[0].empty() && results.reason[1].empty()));
}

TEST_CASE("an unterminated last row is told, and read only when asked for") {
  const std::string text = good_header + "0,deployed,1,2,root,";
  CHECK(read(text, {{"k"}, {"t"}}, UnterminatedRow::read).results.size() == 1);
  const ResultsFile dropped = read(text, {{"k"}, {"t"}}, UnterminatedRow::drop);
  CHECK(dropped.results.size() == 0);
  CHECK(dropped.complete_bytes == good_header.size());
  CHECK(dropped.unterminated);
}

TEST_CASE("a quote that is open from an earlier line on hides rows: no last row to be dropped") {
  const std::string text = good_header + "0,deployed,1,2,\"root,\n1,deployed,1,2,root,\n";
  for (const UnterminatedRow last : {UnterminatedRow::read, UnterminatedRow::drop})
    CHECK_THROWS_WITH(
        read(text, {{"k"}, {"t"}}, last),
        "runs.csv: line 2: found a quote that is never closed, expected a closing quote");
  const std::string cut = good_header + "0,deployed,1,2,\"ro"; // within the last line
  CHECK(read(cut, {{"k"}, {"t"}}, UnterminatedRow::drop).complete_bytes == good_header.size());
}

TEST_CASE("runs.csv: faults in the header") {
  CHECK_THROWS_WITH(read_small(""), "runs.csv: line 1: found an empty file, expected a header");
  CHECK_THROWS_WITH(
      read_small("run,k,t,latch_order\n"),
      "runs.csv: line 1, column 'status': found no such column, expected it in the header");
  CHECK_THROWS_WITH(
      read_small("run,status,k,t,t,latch_order\n"),
      "runs.csv: line 1, column 't': found the column more than once, expected each column once");
  CHECK_THROWS_WITH(
      read_small("run,status,k,t,extra,latch_order\n"),
      "runs.csv: line 1, column 'extra': found a column that the campaign does not have, "
      "expected only run, status, k, t, latch_order, reason");
}

TEST_CASE("runs.csv: faults in a row") {
  const auto read_row = [](const std::string& row) { return read_small(good_header + row); };
  CHECK_THROWS_WITH(read_row("0,deployed,1,2,root\n"),
                    "runs.csv: line 2: found 5 cells, expected 6, as in the header");
  CHECK_THROWS_WITH(read_row("\n"),
                    "runs.csv: line 2: found 1 cells, expected 6, as in the header");
  CHECK_THROWS_WITH(read_row("0,deploid,1,2,root,\n"),
                    "runs.csv: line 2, column 'status': found 'deploid', expected one of deployed, "
                    "stalled, timed_out, invalid, failed");
  for (const std::string number :
       {"fast", "1.5x", " 1", "nan", "inf", "1e999", "0x10", "1,5", "--1"}) {
    const std::string quoted = "\"" + number + "\"";
    CHECK_THROWS_WITH(read_row("0,deployed,1," + quoted + ",root,\n"),
                      "runs.csv: line 2, column 't': found '" + number +
                          "', expected a finite number, or nothing");
  }
}

TEST_CASE("runs.csv: run numbers are whole and increase") {
  const auto read_runs = [](const std::string& first, const std::string& second) {
    return read_small(good_header + first + ",deployed,1,2,root,\n" + second +
                      ",deployed,1,2,root,\n");
  };
  CHECK(read_runs("0", "5").runs == std::vector<long>{0, 5});
  const std::string must = "', expected a whole number of at least ";
  CHECK_THROWS_WITH(read_runs("-1", "0"), "runs.csv: line 2, column 'run': found '-1" + must +
                                              "0 (runs count from 0, in order)");
  CHECK_THROWS_WITH(read_runs("1.0", "2"), "runs.csv: line 2, column 'run': found '1.0" + must +
                                               "0 (runs count from 0, in order)");
  CHECK_THROWS_WITH(read_runs("4", "4"), "runs.csv: line 3, column 'run': found '4" + must +
                                             "5 (runs count from 0, in order)");
}

TEST_CASE("whether peaks are proven is a column of its own, where it is recorded") {
  const ResultNames columns{{"k"}, {"t"}, true};
  Results results(columns);
  results.append({0, Status::deployed, {1}, {2}, "root", "", PeaksFinal::yes});
  results.append({1, Status::timed_out, {1}, {none}, "", "why", PeaksFinal::no});
  results.append({2, Status::failed, {1}, {none}, "", "why", PeaksFinal::unknown});
  results.append({3, Status::deployed, {1}, {2}, "root", "", PeaksFinal::moments});
  results.append({4, Status::deployed, {1}, {2}, "root", "", PeaksFinal::forces});
  const std::string text = write(results, columns);
  CHECK(text == "run,status,k,t,peaks_final,latch_order,reason\n0,deployed,1,2,true,root,\n"
                "1,timed_out,1,,false,,why\n2,failed,1,,,,why\n3,deployed,1,2,peak_moment,root,\n"
                "4,deployed,1,2,peak_force,root,\n");
  CHECK((count_cut(results, "root.peak_moment") == 2 &&
         count_cut(results, "root.peak_force") == 2 && count_cut(results, "root.latch_time") == 0));
  const Results again = read(text, columns).results;
  check_same(results, again, 5);
  for (std::size_t i = 0; i < 5; ++i) CHECK(again.peaks_final[i] == results.peaks_final[i]);
  CHECK(write(again, columns) == text);
  SpecError error({});
  try {
    (void)read("run,status,k,t,peaks_final,latch_order\n0,deployed,1,2,yes,root\n", columns);
  } catch (const SpecError& caught) {
    error = caught;
  }
  CHECK_THAT(
      error.what(),
      Catch::Contains("column 'peaks_final': found 'yes', expected true, false, peak_moment, "
                      "peak_force, or nothing"));
  CHECK_THROWS_AS(read("run,status,k,t,latch_order\n", columns), SpecError);
  CHECK_THROWS_AS(read(text, {{"k"}, {"t"}}), SpecError); // not its column
}
