#include "montecarlo/model/input_checks/input_warning.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace wingspread {

namespace {

/// Whether a pointer like "/hinges/3/spring" leads to an element that the file does not have.
bool is_of_copy(const ScenePlace& place, const std::string& pointer) {
  const std::size_t key = pointer.find('/', 1);
  if (key == std::string::npos) return false;
  const auto count = place.written.find(pointer.substr(1, key - 1));
  return count != place.written.end() &&
         std::strtoul(pointer.c_str() + key + 1, nullptr, 10) >= count->second;
}

} // namespace

std::string to_string(const InputWarning& warning) {
  std::string line;
  for (const std::string& place : {warning.file, warning.pointer})
    if (!place.empty()) line += place + ": ";
  return line + "found " + warning.found + ", usual is " + warning.usual;
}

void InputWarnings::add(const std::string& pointer, std::string found, std::string usual) {
  if (is_of_copy(place_, pointer)) return;
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
