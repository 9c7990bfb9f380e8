/// What is noticed of an input that can be run, but is probably not what was meant.
#pragma once

#include "montecarlo/foundation/formats/spec_error.hpp"

#include <string>
#include <vector>

namespace wingspread {

/// Where a scene stands: its file, and what its JSON pointers begin with ("/scene" inside of a campaign).
struct ScenePlace {
  std::string file;
  std::string prefix{};
};

/// What was found, and what is usual; a problem that is none.
struct Notice {
  std::string file, pointer;
  std::string found, usual;
  bool operator==(const Notice&) const = default;
};

/// "FILE: POINTER: found …, usual is …" on one line.
[[nodiscard]] std::string to_string(const Notice& notice);

/// The notices of one input. Of each place there is at most one: the first.
class Notices {
public:
  explicit Notices(ScenePlace place) : place_(std::move(place)) {}

  /// @param pointer within the place
  void add(const std::string& pointer, std::string found, std::string usual);

  [[nodiscard]] const ScenePlace& place() const { return place_; }
  [[nodiscard]] const std::vector<Notice>& list() const { return list_; }

private:
  ScenePlace place_;
  std::vector<Notice> list_;
};

/// Those that are errors to whoever asks for it.
[[nodiscard]] SpecError as_errors(const std::vector<Notice>& notices);

} // namespace wingspread
