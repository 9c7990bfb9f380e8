#include "montecarlo/formats/spec_error.hpp"

#include <utility>

namespace wingspread {

std::string to_string(const Problem& problem) {
  std::string line;
  if (!problem.file.empty()) line += problem.file + ": ";
  if (!problem.pointer.empty()) line += problem.pointer + ": ";
  return line + "found " + problem.found + ", expected " + problem.expected;
}

SpecError::SpecError(std::vector<Problem> problems) : problems_(std::move(problems)) {
  for (const Problem& problem : problems_) {
    if (!message_.empty()) message_ += '\n';
    message_ += to_string(problem);
  }
}

} // namespace wingspread
