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
    Entry{"HINGE.latch_time", "when the hinge reaches its latched angle for the first time; of a "
                              "latch that may miss or let go, when it engaged for good"},
    Entry{"HINGE.latch_rate",
          "the hinge's relative rate at that instant; the sign is the sense of rotation, "
          "counter-clockwise positive"},
    Entry{"HINGE.rate_at.OTHER", "the hinge's relative rate when hinge OTHER latches, signed"},
    Entry{"HINGE.peak_moment", "largest |moment| that the hinge transmits about its axis in the "
                               "whole run: springs, harness, "
                               "friction, dampers, motor, stops, loops and latch together"},
    Entry{"HINGE.peak_force", "largest force across the hinge over the whole run"},
    Entry{
        "HINGE.overtravel",
        "largest rotation of the hinge beyond its stowed angle, away from the latch; in a stalled "
        "run up to its end"},
    Entry{"HINGE.hold_moment", "largest |moment| that the hold of the hinge bore before it let go"},
    Entry{"HINGE.captures", "how many times the latch engaged"},
    Entry{"HINGE.held", "1 if the latch holds at the end of the run, else 0"},
    Entry{"HINGE.final_angle", "the hinge's angle at t_end, from its latched angle"},
    Entry{
        "HINGE.motor_energy",
        "work of the hinge's motor on the wing while the hinge's latch is not engaged; below 0 if "
        "the motor brakes"},
    Entry{
        "BODY.peak_bending_moment",
        "largest |moment| in a flexible body over the whole run: in its joints, and in the hinges "
        "at its ends"},
    Entry{"mode_K.frequency", "natural frequency of the draw's wing with every latch engaged, "
                              "lowest first; without damping"},
    Entry{"base.peak_angle", "largest change of a free base's angle from the start"},
    Entry{"base.peak_rate", "largest change of a free base's rate from the start"},
    Entry{"deployment_time", "latch time of the last hinge with a latch"}};

constexpr std::array terms{
    Entry{"deployed",
          "every latch engaged, no hinge still held; a hinge without a latch is not judged"},
    Entry{"stalled", "a latch is proven never to engage, or a hinge was never released"},
    Entry{"timed_out", "t_end was reached before every latch engaged"},
    Entry{"invalid", "the draw is unphysical, e.g. a mass below 0"},
    Entry{"failed", "the integration could not continue"},
    Entry{"nominal", "the run with every dispersion at its median in the case"},
    Entry{"observed", "of a requirement: the share of runs that meet it, and the quantile at the "
                      "required share"},
    Entry{"confidence bound",
          "the same with the required confidence for the population of wings: a "
          "binomial bound, and the tolerance limit of Wilks"},
    Entry{"margin", "distance from the confidence bound to the limit: at least 0 for a pass"},
    Entry{"undecided",
          "too few runs to show the requirement, whatever their outcome; or only peaks "
          "that t_end cut stand against a pass"},
    Entry{"bounds", "of shares: exact (Clopper-Pearson); of quantiles: order statistics; both for "
                    "independent draws"},
    Entry{"latch order", "the hinges' names in the order of their latching"},
    Entry{"Spearman", "rank correlation, from -1 to 1: the strength of a monotone relation"},
    Entry{"PRCC", "partial rank correlation: the effect of one dispersion with all others held"},
    Entry{"first-order index",
          "the share of an output's variance that one dispersion causes alone"},
    Entry{"total index", "the share that remains when all other dispersions are known"}};

} // namespace

Json glossary_json() {
  Json json = Json::object();
  for (const auto& [name, text] : outputs)
    json[name] = {{"unit", parse_output_name(name).unit}, {"text", text}};
  for (const auto& [name, text] : terms) json[name] = {{"unit", ""}, {"text", text}};
  return json;
}

} // namespace wingspread
