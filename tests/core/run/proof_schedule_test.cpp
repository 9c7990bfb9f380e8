#include "core/run/proof_schedule.hpp"

#include <catch2/catch.hpp>

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
