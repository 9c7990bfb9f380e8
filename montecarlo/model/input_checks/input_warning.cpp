#include "montecarlo/model/input_checks/input_warning.hpp"

#include <algorithm>
#include <utility>

namespace wingspread {

std::string to_string(const InputWarning& warning) {
  std::string line;
  for (const std::string& place : {warning.file, warning.pointer})
    if (!place.empty()) line += place + ": ";
  return line + "found " + warning.found + ", usual is " + warning.usual;
}

void InputWarnings::add(const std::string& pointer, std::string found, std::string usual) {
  const std::string whole = place_.prefix + pointer;
  if (std::ranges::find(list_, whole, &InputWarning::pointer) != list_.end()) return;
  list_.push_back({place_.file, whole, std::move(found), std::move(usual)});
}

SpecError as_errors(const std::vector<InputWarning>& warnings) {
  std::vector<Problem> problems;
  for (const InputWarning& warning : warnings)
    problems.push_back({warning.file, warning.pointer, warning.found, warning.usual});
  return SpecError(std::move(problems));
}

} // namespace wingspread
