#include "montecarlo/results/summary/reason_pattern.hpp"

#include <algorithm>
#include <charconv>

namespace wingspread {
namespace {

bool is_digit(char c) { return '0' <= c && c <= '9'; }

bool is_of_name(char c) {
  return is_digit(c) || ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z') || c == '_' || c == '.';
}

/// Length of the number that the text begins with; 0 when it begins with none.
std::size_t number_length(std::string_view text) {
  const std::size_t sign = text.starts_with('-') ? 1 : 0;
  if (text.size() == sign || !is_digit(text[sign])) return 0;
  double value = 0;
  const char* end = std::from_chars(text.data(), text.data() + text.size(), value).ptr;
  const auto length = static_cast<std::size_t>(end - text.data());
  return length < text.size() && is_of_name(text[length]) ? 0 : length;
}

} // namespace

ReasonPattern pattern_of(std::string_view reason) {
  ReasonPattern pattern{{""}, {}};
  while (!reason.empty()) {
    std::string& words = pattern.words.back();
    const bool in_name = !words.empty() && is_of_name(words.back());
    if (const std::size_t length = in_name ? 0 : number_length(reason); length > 0) {
      pattern.numbers.emplace_back(reason.substr(0, length));
      pattern.words.emplace_back();
      reason.remove_prefix(length);
    } else {
      words += reason.front();
      reason.remove_prefix(1);
    }
  }
  return pattern;
}

void widen(ReasonPattern& pattern, const ReasonPattern& other) {
  for (std::size_t i = 0; i < pattern.numbers.size(); ++i)
    if (pattern.numbers[i] != other.numbers[i]) pattern.numbers[i] = "…";
}

std::string to_string(const ReasonPattern& pattern) {
  std::string text = pattern.words.front();
  for (std::size_t i = 0; i < pattern.numbers.size(); ++i)
    text += pattern.numbers[i] + pattern.words[i + 1];
  return text;
}

void ReasonCounts::add(Status status, std::string_view reason) {
  if (reason.empty()) return;
  const ReasonPattern pattern = pattern_of(reason);
  Group& group = groups.try_emplace({status, pattern.words}, Group{pattern}).first->second;
  widen(group.pattern, pattern);
  ++group.count;
}

void ReasonCounts::add(const ReasonCounts& other) {
  for (const auto& [key, theirs] : other.groups) {
    Group& group = groups.try_emplace(key, Group{theirs.pattern}).first->second;
    widen(group.pattern, theirs.pattern);
    group.count += theirs.count;
  }
}

std::vector<ReasonCount> ReasonCounts::sorted() const {
  std::vector<ReasonCount> reasons;
  for (const auto& [key, group] : groups)
    reasons.push_back({key.first, to_string(group.pattern), group.count});
  std::ranges::stable_sort(reasons, [](const ReasonCount& a, const ReasonCount& b) {
    return a.status != b.status ? a.status < b.status : a.count > b.count;
  });
  return reasons;
}

} // namespace wingspread
