#include "montecarlo/foundation/platform/progress.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE("the line of progress says what is done, how fast, and what is left") {
  CHECK(progress_line({.done = 250, .total = 1000}, 0.5) ==
        "██████░░░░░░░░░░░░░░░░░░ 250/1000 runs · 500 runs/s · 2 s left");
  CHECK(progress_line({.done = 1000, .total = 1000}, 2) ==
        "████████████████████████ 1000/1000 runs · 500 runs/s");
}

TEST_CASE("runs of an earlier session do not count in the rate") {
  CHECK(progress_line({.done = 600, .total = 1000, .before = 500}, 50) ==
        "██████████████░░░░░░░░░░ 600/1000 runs · 2 runs/s · 3 min 20 s left");
  CHECK(progress_line({.done = 500, .total = 40000, .before = 400}, 20) ==
        "░░░░░░░░░░░░░░░░░░░░░░░░ 500/40000 runs · 5 runs/s · 2 h 11 min left");
}

TEST_CASE("before the first run there is no rate, and of no runs all are done") {
  CHECK(progress_line({.total = 10}, 0) == "░░░░░░░░░░░░░░░░░░░░░░░░ 0/10 runs");
  CHECK(progress_line({}, 1) == "████████████████████████ 0/0 runs");
}

TEST_CASE("invalid and failed runs are counted in sight") {
  CHECK(progress_line({.done = 24, .total = 24, .invalid = 3, .failed = 1}, 1) ==
        "████████████████████████ 24/24 runs · 24 runs/s · 3 invalid · 1 failed");
}

TEST_CASE("runs that did not deploy are counted in sight") {
  CHECK(progress_line({.done = 24, .total = 24, .stalled = 5, .timed_out = 2}, 1) ==
        "████████████████████████ 24/24 runs · 24 runs/s · 5 stalled · 2 timed out");
}

TEST_CASE("nothing is written to what is no terminal") {
  std::FILE* file = std::tmpfile();
  REQUIRE(file);
  {
    Progress progress(file);
    progress.show({.done = 1, .total = 2});
    progress.show({.done = 2, .total = 2});
  }
  CHECK(std::ftell(file) == 0);
  std::fclose(file);
}

TEST_CASE("a study's line says which analysis is under way, and that its totals are bounds") {
  RunCounts counts =
      counts_of({.analysis = 7, .most_analyses = 31, .runs = 12'400, .most_runs = 62'000}, 2'400);
  CHECK(progress_line(counts, 10) == "████░░░░░░░░░░░░░░░░░░░░ analysis 7 of at most 31 · 12400 of "
                                     "at most 62000 runs · 1000 runs/s");
  counts = counts_of({.runs = 300, .most_runs = 1000}, 0); // of what has no analyses to speak of
  CHECK(progress_line(counts, 3) ==
        "███████░░░░░░░░░░░░░░░░░ 300 of at most 1000 runs · 100 runs/s");
}

TEST_CASE("no line goes beyond the end") {
  CHECK(progress_line({.done = 12, .total = 10}, 0).starts_with("████████████████████████ 12/10"));
}

TEST_CASE("a single run that did not deploy is in sight, and none is no word") {
  const auto has = [](const RunCounts& counts, const char* words) {
    return progress_line(counts, 1).find(words) != std::string::npos;
  };
  for (const long count : {0L, 1L}) {
    CHECK(has({.done = 24, .total = 24, .stalled = count}, "stalled") == (count > 0));
    CHECK(has({.done = 24, .total = 24, .timed_out = count}, "timed out") == (count > 0));
    CHECK(has({.done = 24, .total = 24, .invalid = count}, "invalid") == (count > 0));
    CHECK(has({.done = 24, .total = 24, .failed = count}, "failed") == (count > 0));
  }
}
