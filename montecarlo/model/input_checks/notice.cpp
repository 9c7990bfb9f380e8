#include "montecarlo/model/input_checks/notice.hpp"

#include <algorithm>
#include <utility>

namespace wingspread {

std::string to_string(const Notice& notice) {
  std::string line;
  for (const std::string& place : {notice.file, notice.pointer})
    if (!place.empty()) line += place + ": ";
  return line + "found " + notice.found + ", usual is " + notice.usual;
}

void Notices::add(const std::string& pointer, std::string found, std::string usual) {
  const std::string whole = place_.prefix + pointer;
  if (std::ranges::find(list_, whole, &Notice::pointer) != list_.end()) return;
  list_.push_back({place_.file, whole, std::move(found), std::move(usual)});
}

SpecError as_errors(const std::vector<Notice>& notices) {
  std::vector<Problem> problems;
  for (const Notice& notice : notices)
    problems.push_back({notice.file, notice.pointer, notice.found, notice.usual});
  return SpecError(std::move(problems));
}

} // namespace wingspread
