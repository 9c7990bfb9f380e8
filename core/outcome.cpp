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

} // namespace wingspread
