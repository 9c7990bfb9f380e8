#include "montecarlo/report/text/outcome_report.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE("the warning of cut peaks names the kind that is not final, and both kinds as peaks") {
  Outcome outcome;
  outcome.status = Status::timed_out;
  outcome.peak_moment = {{1, 1}}, outcome.peak_force = {{1, 1}};
  for (const bool moments : {false, true})
    for (const bool forces : {false, true}) {
      CAPTURE(moments, forces);
      outcome.moments_final = moments, outcome.forces_final = forces;
      outcome.peaks_final = moments && forces;
      CHECK(has_cut_peaks(outcome) == !(moments && forces));
      if (outcome.peaks_final) continue;
      const std::string text = cut_peaks_warning(outcome);
      CHECK((text.find("peak moments") != std::string::npos) == forces);
      CHECK((text.find("peak forces") != std::string::npos) == moments);
      CHECK((text.find("peaks") != std::string::npos) == !(moments || forces));
    }
}
