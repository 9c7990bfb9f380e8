#include "montecarlo/model/starter/annotated_json.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace wingspread {
namespace {

std::string without_indent(const std::string& line) {
  return line.substr(std::min(line.find_first_not_of(' '), line.size()));
}

} // namespace

std::string json_file_text(const AnnotatedLines& lines) {
  std::string text;
  for (const AnnotatedLine& line : lines) text += line.json + '\n';
  return text;
}

std::string notes_table(const AnnotatedLines& lines) {
  std::string text = "| line | what it says |\n|---|---|\n";
  for (const AnnotatedLine& line : lines)
    if (!line.note.empty())
      text += fmt::format("| `{}` | {} |\n", without_indent(line.json), line.note);
  return text;
}

AnnotatedLines joined(std::vector<AnnotatedLines> elements) {
  AnnotatedLines all;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (i + 1 < elements.size()) elements[i].back().json += ',';
    all.insert(all.end(), elements[i].begin(), elements[i].end());
  }
  return all;
}

std::string short_number(double value) { return fmt::format("{:.6g}", value); }

} // namespace wingspread
