#include "montecarlo/engine/runs/in_order.hpp"

#include <catch2/catch.hpp>

#include <atomic>
#include <thread>
#include <vector>

using namespace wingspread;

namespace {

Batch batch_of(long run) {
  Batch batch;
  batch.rows.resize(1);
  batch.rows.front().run = run;
  return batch;
}

/// The runs that were handed on.
struct Sink {
  std::vector<long> runs{};
  BatchSink take{[this](const Batch& batch) { runs.push_back(batch.rows.front().run); }};
};

} // namespace

TEST_CASE("batches are handed on in the order of their chunks, up to one that was broken off") {
  Sink sink;
  InOrder in_order(sink.take, 10);
  for (const long chunk : {2, 0, 3, 1}) in_order.finish(chunk, batch_of(chunk), true);
  CHECK(sink.runs == std::vector<long>{0, 1, 2, 3});
  in_order.finish(4, batch_of(4), false);
  in_order.finish(5, batch_of(5), true);
  CHECK(sink.runs == std::vector<long>{0, 1, 2, 3, 4});
  CHECK(in_order.done() == 5);
}

TEST_CASE("no chunk is begun far ahead of the oldest one that is not finished") {
  Sink sink;
  InOrder in_order(sink.take, 3);
  CHECK(in_order.may_begin(2));
  CHECK_FALSE(in_order.may_begin(3));
  in_order.finish(1, batch_of(1), true);
  in_order.finish(2, batch_of(2), true);
  CHECK_FALSE(in_order.may_begin(3)); // two wait for the first, which is slow
  in_order.finish(0, batch_of(0), true);
  CHECK(in_order.may_begin(5));
  CHECK_FALSE(in_order.may_begin(6));
}

TEST_CASE("who waits for its turn goes on when the slow one is finished, or all work has ended",
          "[parallel]") {
  Sink sink;
  InOrder in_order(sink.take, 1);
  std::atomic<bool> ended = false;
  std::atomic<int> gone_on = 0;
  const auto wait_for = [&](long chunk) {
    in_order.wait_for(chunk, [&] { return ended.load(); });
    ++gone_on;
  };
  std::thread next(wait_for, 1L), later(wait_for, 5L);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  CHECK(gone_on == 0);
  in_order.finish(0, batch_of(0), true);
  next.join();
  CHECK(gone_on == 1);
  ended = true;
  later.join();
  CHECK(gone_on == 2);
}
