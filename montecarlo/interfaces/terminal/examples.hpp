/// The scenes and campaigns that come with the program.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wingspread {

struct Example {
  std::string name; ///< of the campaign, e.g. "yoke_wing"
  std::vector<std::pair<std::string, std::string>>
      files; ///< name and text: campaign.json, scene.json
};

/// The folder with `scenes` and `campaigns` that belongs to the program at this path: PREFIX/share/wingspread/examples
/// of PREFIX/bin/wingspread, or `studies` of the source folder in which it was built.
[[nodiscard]] std::optional<std::filesystem::path>
examples_folder(const std::filesystem::path& program);

/// Reads the example whose name begins with the given one. The campaign names its scene "scene.json".
/// @throws SpecError that lists the examples, unless exactly one begins so or is named so
[[nodiscard]] Example read_example(const std::string& name);
[[nodiscard]] Example read_example(const std::string& name, const std::filesystem::path& folder);

} // namespace wingspread
