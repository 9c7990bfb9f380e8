#include "montecarlo/interfaces/terminal/examples.hpp"

#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/json_parse.hpp"
#include "montecarlo/foundation/formats/spec_error.hpp"
#include "montecarlo/model/starter/starter.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <system_error>

namespace wingspread {
namespace {

namespace fs = std::filesystem;

/// The names of all campaigns that are run on one scene file and need no other file.
std::vector<std::string> example_names(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder / "campaigns"))
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  std::ranges::sort(names);
  return names;
}

/// The names that begin with `name`, or the one that is `name`.
std::vector<std::string> matching(const std::vector<std::string>& names, const std::string& name) {
  if (std::ranges::find(names, name) != names.end()) return {name};
  std::vector<std::string> found;
  std::ranges::copy_if(names, std::back_inserter(found),
                       [&](const std::string& each) { return each.starts_with(name); });
  return found;
}

std::string text_of(const fs::path& file) {
  if (auto text = read_text(file)) return *std::move(text);
  throw SpecError({{file.string(), "", "no file", "an example that came with the program"}});
}

} // namespace

std::optional<fs::path> examples_folder(const fs::path& program) {
  const fs::path beside = program.parent_path();
  for (const fs::path& folder : {beside / "../share/wingspread/examples", beside / "../../studies"})
    if (fs::is_directory(folder / "campaigns") && fs::is_directory(folder / "scenes"))
      return fs::weakly_canonical(folder);
  return std::nullopt;
}

Example read_example(const std::string& name, const fs::path& folder) {
  const std::vector<std::string> names = example_names(folder);
  const std::vector<std::string> found = matching(names, name);
  if (found.size() != 1)
    throw SpecError(
        {{"", "--example", '"' + name + '"', fmt::format("one of {}", fmt::join(names, ", "))}});
  const fs::path file = folder / "campaigns" / (found.front() + ".json");
  std::string campaign = text_of(file);
  const std::string scene = parse_json(campaign, file.string())["scene"].get<std::string>();
  const std::size_t at = campaign.find('"' + scene + '"');
  campaign.replace(at + 1, scene.size(), starter_scene_file);
  return {found.front(),
          {{starter_campaign_file, campaign},
           {starter_scene_file, text_of(file.parent_path() / scene)}}};
}

Example read_example(const std::string& name) {
  std::error_code no_proc; // a bare root may not have it: then a package's program is assumed
  fs::path program = fs::read_symlink("/proc/self/exe", no_proc);
  if (no_proc) program = "/usr/bin/wingspread";
  const auto folder = examples_folder(program);
  if (!folder)
    throw SpecError({{"", "--example", "no examples beside this program",
                      "share/wingspread/examples in the folder that has bin/wingspread"}});
  return read_example(name, *folder);
}

} // namespace wingspread
