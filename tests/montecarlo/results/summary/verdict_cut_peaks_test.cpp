#include "montecarlo/results/summary/verdict.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE("peaks that t_end cut show nothing: neither a pass nor its opposite") {
  const auto verdict_on = [](double limit, PeaksFinal final, long runs = 1000) {
    Results results(ResultNames{{}, {"root.peak_moment"}, true});
    for (long run = 0; run < runs; ++run)
      results.append({run, Status::deployed, {}, {100}, "", "", final});
    return judge({"", "root.peak_moment", limit, {}, .95, .9}, results);
  };
  const Verdict open = verdict_on(300, PeaksFinal::no); // it may rise beyond 300, or not
  CHECK(open.decision == Decision::undecided);
  CHECK((!open.disproved && open.cut == 1000 && open.open == 1000 && open.failures() == 1000));
  CHECK(rests_on_cut_peaks(open));
  CHECK(evidence(open) == "1000 of 1000 runs break it (1000 of them because t_end cut their "
                          "peaks); at most 40 may. A cut peak may still rise and shows nothing: "
                          "lengthen t_end");
  CHECK_FALSE(is_decided(open));
  const Verdict beyond = verdict_on(99, PeaksFinal::no); // it is beyond 99 already
  CHECK((beyond.decision == Decision::fail && beyond.disproved && beyond.open == 0));
  CHECK(verdict_on(300, PeaksFinal::yes).decision == Decision::pass);
  CHECK(verdict_on(300, PeaksFinal::moments).decision == Decision::pass); // only forces are cut
  CHECK(verdict_on(300, PeaksFinal::forces).decision == Decision::undecided);
  const Verdict one = verdict_on(300, PeaksFinal::no, 1);
  CHECK((one.decision == Decision::undecided && !one.disproved));
  CHECK(verdict_on(99, PeaksFinal::no, 1).disproved);
}
