/// A JSON file with a note on each of its lines, because JSON has no comments.
#pragma once

#include <string>
#include <vector>

namespace wingspread {

/// A line of a JSON file, and what it says. Lines without a note repeat what earlier ones say for another body or
/// hinge.
struct AnnotatedLine {
  std::string json;
  std::string note{};
};
using AnnotatedLines = std::vector<AnnotatedLine>;

/// The JSON file: the lines without their notes.
[[nodiscard]] std::string json_file_text(const AnnotatedLines& lines);

/// A Markdown table: each line beside its note.
[[nodiscard]] std::string notes_table(const AnnotatedLines& lines);

/// Puts a comma behind every element but the last. @pre every element has a line
[[nodiscard]] AnnotatedLines joined(std::vector<AnnotatedLines> elements);

/// A number for JSON: up to six significant digits.
[[nodiscard]] std::string short_number(double value);

} // namespace wingspread
