#include "montecarlo/engine/runs/finality.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE("the runs that t_end cut are counted once, and by the kind of the peak that is cut") {
  PeaksCount count;
  count.add(PeaksFinal::yes, 5);
  count.add(PeaksFinal::unknown, 6);
  count.add(PeaksFinal::moments, 2); // their forces are cut
  CHECK((count.cut == 2 && count.forces_cut == 2 && count.moments_cut == 0));
  CHECK(cut_peaks_text(count, 20) == "in 2 of 20 runs t_end cut the peak forces");
  count.add(PeaksFinal::forces, 4);
  count.add(PeaksFinal::no, 3);
  CHECK((count.proven == 5 && count.unknown == 6));
  CHECK((count.cut == 2 + 4 + 3 && count.moments_cut == 4 + 3 && count.forces_cut == 2 + 3));
  CHECK(cut_peaks_text(count, 20) == "in 9 of 20 runs t_end cut peaks (moments in 7, forces in 5)");
  PeaksCount moments, both;
  moments.add(PeaksFinal::forces), both.add(PeaksFinal::no);
  CHECK(cut_peaks_text(moments, 7) == "in 1 of 7 runs t_end cut the peak moments");
  CHECK(cut_peaks_text(both, 7) == "in 1 of 7 runs t_end cut the peaks");
}

TEST_CASE("a longer t_end is advised unless there is a reason why none will do") {
  CHECK(advice_on_t_end("") == "Lengthen t_end");
  CHECK(advice_on_t_end("in air") == "No t_end will do in air");
  CHECK_THAT(warn_of_open_latches(2, 5, ""),
             Catch::StartsWith("in 2 of 5 runs ") && Catch::EndsWith(advice_on_t_end("")));
  CHECK_THAT(warn_of_open_latches(2, 5, "in air"), Catch::EndsWith(advice_on_t_end("in air")));
}

TEST_CASE("what is proven of a run's peaks has a word, which is read back") {
  for (const PeaksFinal final : all_peaks_final)
    CHECK(peaks_final_named(to_string(final)) == final);
  CHECK_FALSE(peaks_final_named("perhaps"));
  Outcome outcome;
  outcome.status = Status::timed_out;
  outcome.peaks_final = outcome.moments_final = outcome.forces_final = false;
  CHECK(peaks_final_of(outcome) == PeaksFinal::no);
  outcome.forces_final = true;
  CHECK(peaks_final_of(outcome) == PeaksFinal::forces);
  outcome.forces_final = false, outcome.moments_final = true;
  CHECK(peaks_final_of(outcome) == PeaksFinal::moments);
  outcome.peaks_final = true;
  CHECK(peaks_final_of(outcome) == PeaksFinal::yes);
  for (const Status none : {Status::invalid, Status::failed}) {
    outcome.status = none;
    CHECK(peaks_final_of(outcome) == PeaksFinal::unknown);
  }
}
