/// For the tests of JSON readers: small documents, ways to spoil them, and the messages.
#pragma once

#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/json_parse.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/foundation/formats/spec_error.hpp"

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <unistd.h>
#include <vector>

namespace wingspread::test {

/// A wing of two panels; its second hinge has neither spring nor latch.
inline Json small_scene() {
  return parse_json(R"({
    "name": "small",
    "base": { "motion": "fixed" },
    "bodies": [ { "name": "inner", "mass": 10, "inertia": 0.5 },
                { "name": "outer", "mass": 8, "inertia": 0.25 } ],
    "hinges": [
      { "name": "root", "parent": "base", "child": "inner",
        "parent_point": [0, 0], "child_point": [-0.5, 0.02],
        "angle": { "stowed": 1.5, "latched": 0 }, "initial_rate": -0.1,
        "spring": { "torque_stowed": 2, "torque_latched": 1.4 },
        "harness": { "torque_stowed": 0.1, "torque_latched": 0.2 },
        "friction": { "coulomb": 0.1, "viscous": 0.01, "regularization_rate": 0.002 },
        "latch": { "stiffness": 10000, "damping": 100 } },
      { "name": "mid", "parent": "inner", "child": "outer",
        "parent_point": [0.5, -0.02], "child_point": [-0.5, -0.02],
        "angle": { "stowed": -3, "latched": 0 } } ] })");
}

/// The same wing with all optional parts of hinges.
inline Json real_scene() {
  Json scene = small_scene();
  Json& root = scene["hinges"][0];
  root["spring"] = parse_json(R"({
    "measured": { "angle": [1.5, 0.8, 0], "deploying": [1.9, 1.5, 1.2], "stowing": [2.1, 1.9, 1.5] },
    "interpolation": "linear", "scale": 1.1, "offset": -0.05 })");
  root["harness"] = parse_json(
      R"({ "table": { "angle": [1.6, 1, 0.2, -0.1], "torque": [0.1, 0.3, 0.2, 0.2] }, "scale": 0.9 })");
  root["friction"]["scale"] = 1.5;
  root["damper"] = parse_json(R"({ "law": "power", "coefficient": 3, "exponent": 0.45,
    "regularization_rate": 1e-5, "window": [1, 0.25], "scale": 0.7 })");
  root["stop"] = parse_json(R"({ "stiffness": 500, "dissipation": 0.2, "gap": 0.01 })");
  root["latch"]["backlash"] = 0.002;
  Json& mid = scene["hinges"][1];
  mid["spring"] = parse_json(R"({ "torque_stowed": 1, "torque_latched": 0.5, "offset": 0.125 })");
  mid["damper"] = parse_json(R"({ "law": "eddy_current", "peak_torque": 2, "peak_rate": 4 })");
  scene["bodies"][0]["plate"] = parse_json(
      R"({ "from": [-0.5, 0.01], "to": [0.5, 0.01], "width": 2, "drag_coefficient": 1.9 })");
  scene["synchronisations"] = parse_json(R"([
    { "name": "loop", "between": ["root", "mid"], "ratio": 2, "stiffness": 300, "damping": 0.5,
      "preload": 8 },
    { "name": "cam", "between": ["mid", "root"], "stiffness": 100,
      "ratio": { "table": { "travel": [0, 1, 3], "travel_of_second": [0, 0.6, 1.5] } } } ])");
  scene["environment"] = parse_json(R"({ "gravity": [0.1, -9.81], "air_density": 1.2 })");
  return scene;
}

/// A campaign with the small scene and two dispersions.
inline Json small_campaign() {
  Json campaign{{"scene", small_scene()}};
  campaign["dispersions"] = parse_json(R"([
    { "name": "spring", "distribution": { "type": "normal", "mean": 1, "std": 0.05 },
      "apply": "scale",
      "to": ["hinges.root.spring.torque_stowed", "hinges.root.spring.torque_latched"] },
    { "name": "mass", "distribution": { "type": "uniform", "lower": 7, "upper": 9 },
      "apply": "set", "each": "bodies.*.mass" } ])");
  return campaign;
}

/// One change to a document, and the message that it causes.
struct Spoiled {
  const char* pointer;
  const char* value;   ///< JSON; empty: the value is removed
  const char* message; ///< all problems, one line each; tests compare its facts (facts_of)
};

inline Json spoil(Json document, const Spoiled& change) {
  const Json::json_pointer at(change.pointer);
  if (*change.value != '\0') {
    document[at] = parse_json(change.value);
  } else if (Json& parent = document[at.parent_pointer()]; parent.is_array()) {
    parent.erase(std::stoul(at.back()));
  } else {
    parent.erase(at.back());
  }
  return document;
}

/// The message of the SpecError or MachineError that `read` throws; empty if it throws neither.
template <class Read> std::string message_of(Read read) {
  try {
    (void)read();
  } catch (const SpecError& error) {
    return error.what();
  } catch (const MachineError& error) {
    return error.what();
  }
  return "";
}

/// The facts of a message: for each line its place, then all its numbers, quoted words, units and comparison signs. Tests
/// compare facts, so that a reworded message does not break them.
inline std::vector<std::string> facts_of(const std::string& message) {
  static const std::regex fact(
      R"re("[^"]*"|'[^']*'|[<>]=?|≤|≥|-?\d+(\.\d+)?(e[-+]?\d+)?|[^\s,;:]*[·²³][^\s,;:]*)re");
  std::vector<std::string> facts;
  std::istringstream lines(message);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t found = line.find("found ");
    facts.push_back(line.substr(0, found));
    const std::string rest = found == line.npos ? "" : line.substr(found);
    for (std::sregex_iterator it(rest.begin(), rest.end(), fact); it != std::sregex_iterator();
         ++it)
      facts.push_back(it->str());
  }
  return facts;
}

/// The problems that `read` notes when it is given the document.
template <class Read> std::string problems_of(const Json& document, Read read) {
  std::vector<Problem> problems;
  read(JsonCursor(document, "", problems));
  return SpecError(problems).what();
}

/// The objects of a document, as pointers, in which a reader passes over a key that it does not know.
/// @param message_for what the reader says of a document: all its problems; empty if there are none
template <class MessageFor>
std::vector<std::string> objects_with_unread_keys(const Json& document, MessageFor message_for) {
  const std::string unknown = "qqqqqqqqqqqqqqqqqqqq";
  std::vector<std::string> found;
  const auto visit = [&](const auto& self, const Json::json_pointer& at) -> void {
    const Json& value = document[at];
    if (value.is_object()) {
      Json changed = document;
      changed[at][unknown] = 1;
      if (message_for(changed).find(unknown) == std::string::npos) found.push_back(at.to_string());
      for (const auto& [key, member] : value.items()) self(self, at / key);
    } else if (value.is_array()) {
      for (std::size_t i = 0; i < value.size(); ++i) self(self, at / i);
    }
  };
  visit(visit, Json::json_pointer());
  return found;
}

/// The settings read (defaults where the document has none), and the problems.
template <class Settings> struct Reading {
  Settings settings;
  std::string problems;
};

template <class Settings>
Reading<Settings> read(const char* json, Settings settings,
                       void (*reader)(const JsonCursor&, Settings&)) {
  const std::string problems =
      problems_of(parse_json(json), [&](const JsonCursor& at) { reader(at, settings); });
  return {settings, problems};
}

/// A temporary folder, removed at the end. The process number is part of its name, because test cases run in parallel
/// processes.
class Folder {
public:
  Folder()
      : path_(std::filesystem::temp_directory_path() /
              ("wingspread_test_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { std::filesystem::remove_all(path_); }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Writes a file; returns its path.
  std::filesystem::path write(const char* name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

private:
  std::filesystem::path path_;
};

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

} // namespace wingspread::test
