/// A warning about an input that is valid but probably not meant. `--strict` makes warnings errors.
#pragma once

#include "montecarlo/foundation/formats/spec_error.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace wingspread {

/// A scene's file, and the prefix of its JSON pointers ("/scene" inside a campaign).
struct ScenePlace {
  std::string file;
  std::string prefix{};
  /// Numbers of elements in the file, by key ("hinges"), where a mirror adds copies. A warning of a copy would repeat
  /// that of its original, at a place that the file lacks.
  std::map<std::string, std::size_t> written{};
};

struct InputWarning {
  std::string file, pointer;
  std::string found, usual;
  bool operator==(const InputWarning&) const = default;
};

/// "FILE: POINTER: found …, usual is …" on one line.
[[nodiscard]] std::string to_string(const InputWarning& warning);

/// Collects the warnings of one input. Keeps the first one of each pointer, and none of a mirrored copy.
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
