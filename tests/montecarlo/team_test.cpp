#include "montecarlo/team.hpp"

#include <catch2/catch.hpp>

#include <atomic>
#include <stdexcept>

using namespace wingspread;

TEST_CASE("a team has the threads asked for", "[parallel]") {
  CHECK(team_size(3) == 3);
  CHECK(team_size(0) >= 1);
  for (const int threads : {1, 2, 5}) {
    std::atomic<int> calls = 0;
    int plain = 0; // written by one thread, read after the team: no race
    on_team(
        threads,
        [&] {
          if (calls++ == 0) plain = threads;
        },
        [] {});
    CHECK(calls == threads);
    CHECK(plain == threads);
  }
}

TEST_CASE("an exception of a thread comes out of the team", "[parallel]") {
  std::atomic<bool> told = false;
  const auto fail = [] { throw std::runtime_error("no more memory"); };
  CHECK_THROWS_WITH(on_team(3, fail, [&] { told = true; }), "no more memory");
  CHECK(told);
}
