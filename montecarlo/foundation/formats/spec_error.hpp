/// Errors in the input: all problems, each with its place, the value found and the value expected.
#pragma once

#include <exception>
#include <string>
#include <vector>

namespace wingspread {

/// One error in the input.
struct Problem {
  std::string file;     ///< as the user named it; empty for text without a file
  std::string pointer;  ///< JSON pointer (RFC 6901) or an option ("--case"); empty: the whole
  std::string found;    ///< the value, as the user wrote it
  std::string expected; ///< the condition it breaks
};

/// "FILE: POINTER: found …, expected …" on one line.
[[nodiscard]] std::string to_string(const Problem& problem);

/// Thrown for wrong input. Holds all problems, so that the user can correct them in one go.
class SpecError : public std::exception {
public:
  explicit SpecError(std::vector<Problem> problems);

  [[nodiscard]] const std::vector<Problem>& problems() const noexcept { return problems_; }
  /// One line per problem, at most 100, and the number of further problems.
  [[nodiscard]] const char* what() const noexcept override { return message_.c_str(); }

private:
  std::vector<Problem> problems_;
  std::string message_;
};

} // namespace wingspread
