/// What is wrong with the input: every problem,
/// with its place, what was found and what was expected.
#pragma once

#include <exception>
#include <string>
#include <vector>

namespace wingspread {

/// One thing wrong with the input.
struct Problem {
  std::string file;     ///< as the user named it; empty for text that came from no file
  std::string pointer;  ///< JSON pointer (RFC 6901); empty for the whole document
  std::string found;    ///< what stands there
  std::string expected; ///< what should
};

/// "FILE: POINTER: found …, expected …" on one line.
[[nodiscard]] std::string to_string(const Problem& problem);

/// Bad input. Holds all of its problems, so that the user mends them in one go.
class SpecError : public std::exception {
public:
  explicit SpecError(std::vector<Problem> problems);

  [[nodiscard]] const std::vector<Problem>& problems() const noexcept { return problems_; }
  /// One line per problem; of very many the first, and how many more there are.
  [[nodiscard]] const char* what() const noexcept override { return message_.c_str(); }

private:
  std::vector<Problem> problems_;
  std::string message_;
};

} // namespace wingspread
