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
