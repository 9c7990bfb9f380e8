#include "core/outcome.hpp"

#include <algorithm>

namespace wingspread {

const char* to_string(Status status) {
  switch (status) {
  case Status::deployed:
    return "deployed";
  case Status::stalled:
    return "stalled";
  case Status::timed_out:
    return "timed_out";
  case Status::invalid:
    return "invalid";
  case Status::failed:
    return "failed";
  }
  return "unknown";
}

const LatchEvent* holding_latch(const Outcome& outcome, int hinge) {
  const auto is_of_hinge = [hinge](const auto& event) { return event.hinge == hinge; };
  const auto last = std::find_if(outcome.latches.rbegin(), outcome.latches.rend(), is_of_hinge);
  if (last == outcome.latches.rend()) return nullptr;
  const auto engaged = std::count_if(outcome.latches.begin(), outcome.latches.end(), is_of_hinge);
  const auto lost = std::count_if(outcome.let_go.begin(), outcome.let_go.end(), is_of_hinge);
  return lost < engaged ? &*last : nullptr;
}

std::string methods_used(const Outcome& outcome) {
  std::vector<std::string> names;
  std::string text;
  for (const Phase& phase : outcome.phases) {
    if (std::find(names.begin(), names.end(), phase.method) != names.end()) continue;
    names.push_back(phase.method);
    text += (text.empty() ? "" : ", ") + phase.method;
  }
  return text;
}

void name_held_hinges(const Scene& scene, Outcome& outcome) {
  if (outcome.never_released.empty()) return;
  outcome.reason.clear();
  const std::vector<int>& later = outcome.may_release_later;
  for (const int hinge : outcome.never_released) {
    if (!outcome.reason.empty()) outcome.reason += "; ";
    outcome.reason += scene.hinges[hinge].name + " was never released";
    if (std::find(later.begin(), later.end(), hinge) != later.end())
      outcome.reason += " up to t_end; its hold may let go later";
  }
}

const Hinge* hinge_with_event_latch(const Scene& scene) {
  const auto found = std::find_if(scene.hinges.begin(), scene.hinges.end(), [](const Hinge& hinge) {
    return hinge.latch && (hinge.latch->can_miss() || hinge.latch->backlash > 0);
  });
  return found == scene.hinges.end() ? nullptr : &*found;
}

} // namespace wingspread
