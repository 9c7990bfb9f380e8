#include "montecarlo/foundation/formats/spec_error.hpp"

#include <algorithm>
#include <utility>

namespace wingspread {
namespace {

constexpr std::size_t most_shown = 100; // problems in a message

} // namespace

std::string to_string(const Problem& problem) {
  std::string line;
  if (!problem.file.empty()) line += problem.file + ": ";
  if (!problem.pointer.empty()) line += problem.pointer + ": ";
  return line + "found " + problem.found + ", expected " + problem.expected;
}

SpecError::SpecError(std::vector<Problem> problems) : problems_(std::move(problems)) {
  for (std::size_t i = 0; i < std::min(problems_.size(), most_shown); ++i) {
    if (i > 0) message_ += '\n';
    message_ += to_string(problems_[i]);
  }
  if (problems_.size() > most_shown)
    message_ += "\nand " + std::to_string(problems_.size() - most_shown) + " more problems";
}

} // namespace wingspread
