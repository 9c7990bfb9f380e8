#include "montecarlo/report/page/glossary.hpp"

#include "montecarlo/foundation/formats/output_name.hpp"

#include <array>
#include <utility>

namespace wingspread {
namespace {

struct Entry {
  const char* name;
  const char* text;
};

/// An owner's name in the glossary, and in words.
std::pair<const char*, const char*> example_of(OutputOwner owner) {
  switch (owner) {
  case OutputOwner::body:
    return {"BODY", "a flexible body"};
  case OutputOwner::mode:
    return {"mode_K", "mode_K"};
  default:
    return {"HINGE", "the hinge"};
  }
}

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
  for (const OutputKind& kind : output_kinds) {
    const auto [owner, word] = example_of(kind.owner);
    const bool two = kind.owner == OutputOwner::two_hinges;
    json[output_name(kind.quantity, owner, two ? "OTHER" : "")] = {
        {"unit", kind.unit}, {"text", meaning_of(kind, word, "hinge OTHER")}};
  }
  for (const auto& [name, text] : terms) json[name] = {{"unit", ""}, {"text", text}};
  return json;
}

} // namespace wingspread
