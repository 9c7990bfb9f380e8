#include "montecarlo/foundation/platform/thread_pool.hpp"

#include <catch2/catch.hpp>

#include <atomic>
#include <stdexcept>

using namespace wingspread;

TEST_CASE("a team has the threads asked for", "[parallel]") {
  CHECK(thread_count(3) == 3);
  CHECK(thread_count(0) >= 1);
  CHECK((threads_for(8, 3) == 3 && threads_for(2, 100) == 2 && threads_for(2, 0) == 1));
  for (const int threads : {1, 2, 5}) {
    std::atomic<int> calls = 0;
    int plain = 0; // written by one thread, read after the team: no race
    run_on_threads(
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
  CHECK_THROWS_WITH(run_on_threads(3, fail, [&] { told = true; }), "no more memory");
  CHECK(told);
}

TEST_CASE("each task is done once, and what one throws comes out", "[parallel]") {
  for (const std::size_t count : {0, 1, 100}) {
    std::vector<int> done(count, 0); // each task writes its own: no race
    for_each_task(3, count, [&](std::size_t i) { ++done[i]; });
    CHECK(done == std::vector<int>(count, 1));
  }
  CHECK_THROWS_WITH(for_each_task(3, 100,
                                  [](std::size_t i) {
                                    if (i == 50) throw std::runtime_error("no more memory");
                                  }),
                    "no more memory");
}

TEST_CASE("little work is one thread's") {
  CHECK(threads_worth(8, 1000) == 1);
  CHECK(threads_worth(8, operations_worth_threads) == 8);
  CHECK(threads_worth(0, operations_worth_threads) == thread_count(0));
}

TEST_CASE("a team is as large as its memory allows") {
  CHECK(threads_within_memory(4, 1000) == 4);
  CHECK(threads_within_memory(4, std::size_t{1} << 29) == 2);
  CHECK(threads_within_memory(4, std::size_t{1} << 40) == 1);
}
