#include "montecarlo/report/page/glossary.hpp"

#include "montecarlo/foundation/formats/output_name.hpp"

#include <array>

namespace wingspread {
namespace {

struct Entry {
  const char* name;
  const char* text;
};

constexpr std::array outputs{
    Entry{"HINGE.latch_time", "when the hinge reaches its latched angle for the first time"},
    Entry{"HINGE.latch_rate",
          "its own relative rate at that instant; the sign is the sense of rotation, "
          "counter-clockwise positive"},
    Entry{"HINGE.rate_at.OTHER", "its relative rate when hinge OTHER latches, signed"},
    Entry{"HINGE.peak_moment",
          "largest |moment| about the hinge's axis over the whole run, the instants behind each "
          "engagement included: springs, harness, friction, dampers, stops, loops and latch"},
    Entry{"HINGE.peak_force", "largest force across the hinge over the whole run"},
    Entry{"HINGE.overtravel",
          "how far the hinge turned beyond its stowed angle, away from the latch; in a stalled run "
          "up to where it ends"},
    Entry{"base.peak_angle", "largest change of a free base's angle from the start"},
    Entry{"base.peak_rate", "largest change of a free base's rate from the start"},
    Entry{"deployment_time", "when the last hinge that has a latch latched"}};

constexpr std::array terms{
    Entry{"deployed", "every latch engaged"},
    Entry{"stalled", "it is proven that a latch never will engage"},
    Entry{"timed_out", "the longest time that a run may take came first"},
    Entry{"invalid", "the draw is unphysical: a mass below 0, say"},
    Entry{"failed", "the integration could not go on"},
    Entry{"nominal", "the run with nothing dispersed"},
    Entry{"observed", "of a requirement: the share of runs that keep to it, and the value that the "
                      "required share of all runs keeps to"},
    Entry{"guaranteed",
          "the same with the required confidence, from a binomial bound: the tolerance "
          "limit of Wilks"},
    Entry{"margin", "from the guaranteed value to the limit: at least 0 for a pass"},
    Entry{"Spearman", "correlation of ranks: how steadily one rises or falls with the other, from "
                      "-1 to 1"},
    Entry{"PRCC", "partial rank correlation: the same with the straight part of all other draws "
                  "taken out"},
    Entry{"first-order index",
          "the share of an output's variance that one dispersion alone is behind"},
    Entry{"total index", "the share that is left when all other dispersions are known"}};

} // namespace

Json glossary_json() {
  Json json = Json::object();
  for (const auto& [name, text] : outputs)
    json[name] = {{"unit", parse_output_name(name).unit}, {"text", text}};
  for (const auto& [name, text] : terms) json[name] = {{"unit", ""}, {"text", text}};
  return json;
}

} // namespace wingspread
