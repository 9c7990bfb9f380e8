/// A warning about an input that is valid but probably not meant. `--strict` makes warnings errors.
#pragma once

#include "montecarlo/foundation/formats/spec_error.hpp"

#include <string>
#include <vector>

namespace wingspread {

/// A scene's file, and the prefix of its JSON pointers ("/scene" inside a campaign).
struct ScenePlace {
  std::string file;
  std::string prefix{};
};

struct InputWarning {
  std::string file, pointer;
  std::string found, usual;
  bool operator==(const InputWarning&) const = default;
};

/// "FILE: POINTER: found …, usual is …" on one line.
[[nodiscard]] std::string to_string(const InputWarning& warning);

/// Collects the warnings of one input. Keeps the first one of each pointer.
class InputWarnings {
public:
  explicit InputWarnings(ScenePlace place) : place_(std::move(place)) {}

  /// @param pointer relative to the place
  void add(const std::string& pointer, std::string found, std::string usual);

  [[nodiscard]] const ScenePlace& place() const { return place_; }
  [[nodiscard]] const std::vector<InputWarning>& list() const { return list_; }

private:
  ScenePlace place_;
  std::vector<InputWarning> list_;
};

/// The warnings as problems of a SpecError.
[[nodiscard]] SpecError as_errors(const std::vector<InputWarning>& warnings);

} // namespace wingspread
