#include "core/run/proof_schedule.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <vector>

using namespace wingspread;

TEST_CASE("attempts that a lane has passed over leave the schedule as if they had been made") {
  for (const long skipped : {1L, 63L, 64L, 65L, 127L, 300L}) {
    ProofSchedule alone, in_lane;
    alone.restart(SoughtProof::stall), in_lane.restart(SoughtProof::stall);
    for (long k = 0; k < skipped; ++k) (void)alone.count_step(SoughtProof::stall);
    in_lane.skip_steps(skipped, SoughtProof::stall);
    CAPTURE(skipped);
    for (int k = 0; k < 200; ++k) {
      CHECK(in_lane.steps_to_attempt() == alone.steps_to_attempt());
      CHECK(in_lane.count_step(SoughtProof::stall) == alone.count_step(SoughtProof::stall));
    }
  }
}

TEST_CASE("an attempt at the peaks that fell due among a lane's steps is still to be made") {
  for (const SoughtProof sought : {SoughtProof::peaks_after_stall, SoughtProof::peaks_by_modes,
                                   SoughtProof::peaks_by_energy}) {
    ProofSchedule schedule;
    schedule.restart(sought);
    schedule.skip_steps(100, sought);
    CHECK(schedule.steps_to_attempt() == 0);
    CHECK(schedule.count_step(sought));
    CHECK_FALSE(schedule.count_step(sought)); // and the next one keeps its distance
  }
}

TEST_CASE("attempts at a proof come at their interval, and the steps before one are counted down") {
  const auto steps_of_attempts = [](SoughtProof sought) {
    ProofSchedule schedule;
    schedule.restart(SoughtProof::stall), schedule.restart(sought); // the last search counts
    std::vector<long> attempts;
    for (long step = 1; step <= 1000; ++step) {
      const long wait = schedule.steps_to_attempt();
      const bool due = schedule.count_step(sought);
      CHECK(due == (wait == 0));
      CHECK((due || schedule.steps_to_attempt() == wait - 1));
      if (due) attempts.push_back(step);
    }
    return attempts;
  };
  const std::vector<long> stall = steps_of_attempts(SoughtProof::stall);
  for (std::size_t k = 0; k < stall.size(); ++k) CHECK(stall[k] == 64 * static_cast<long>(k + 1));
  for (const SoughtProof sought : {SoughtProof::peaks_after_stall, SoughtProof::peaks_by_energy}) {
    const std::vector<long> attempts = steps_of_attempts(sought);
    REQUIRE(attempts.size() == 1000 / 16);
    CHECK((attempts.front() == 16 && attempts.back() == 16 * 62));
  }
  const std::vector<long> by_modes = steps_of_attempts(SoughtProof::peaks_by_modes);
  CHECK(by_modes.front() == 4);
  for (std::size_t k = 1; k < by_modes.size(); ++k) // a quarter of the steps so far
    CHECK(by_modes[k] - by_modes[k - 1] == std::clamp(by_modes[k - 1] / 4, 4L, 64L));
  CHECK(by_modes.size() > 20);
}
