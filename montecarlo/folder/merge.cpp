#include "montecarlo/folder/merge.hpp"

#include "montecarlo/folder/cases_folder.hpp"
#include "montecarlo/folder/folder_writer.hpp"
#include "montecarlo/formats/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace wingspread {
namespace {

/// A folder, and the runs that it has: one range, unless it is broken.
struct Part {
  std::filesystem::path folder;
  Stamp stamp;
  RunRange own; ///< that it should have
  std::vector<RunRange> present{};
};

/// "runs 3 to 5, 8": for messages.
class RunList {
public:
  void add(const RunRange& range) {
    if (range.size() > 0 && ranges_.size() <= most)
      ranges_.push_back(range); // one more than are shown
  }
  [[nodiscard]] bool empty() const { return ranges_.empty(); }
  [[nodiscard]] std::string text() const {
    std::string text;
    for (std::size_t i = 0; i < ranges_.size() && i < most; ++i) {
      const auto& [first, last] = ranges_[i];
      text += i == 0 ? "" : ", ";
      text +=
          last - first == 1 ? fmt::format("{}", first) : fmt::format("{} to {}", first, last - 1);
    }
    if (ranges_.size() > most) text += ", …";
    return text;
  }

private:
  static constexpr std::size_t most = 5;
  std::vector<RunRange> ranges_;
};

/// A problem for each folder that is not of the first one's campaign, seed and version.
void refuse_strangers(const std::vector<Part>& parts) {
  const Part& first = parts.front();
  std::vector<Problem> problems;
  for (const Part& part : parts) {
    const auto compare = [&](const char* key, const std::string& found, const std::string& ours) {
      if (found != ours)
        problems.push_back({(part.folder / campaign_file).string(),
                            fmt::format("/wingspread/{}", key), found,
                            fmt::format("{}, as in {}", ours, first.folder.string())});
    };
    compare("hash", part.stamp.hash, first.stamp.hash);
    compare("version", part.stamp.version, first.stamp.version);
  }
  if (!problems.empty()) throw SpecError(std::move(problems));
}

void refuse_stopping(const StoredCampaign& stored) {
  if (!stored.campaign.until.empty())
    throw SpecError({{(stored.folder / campaign_file).string(), "/until",
                      "a campaign that may stop early", "one that can have shards"}});
}

/// The campaign as one of its folders has it.
StoredCampaign stored_in(const Part& part, const StoredCampaign& whole) {
  StoredCampaign stored = whole;
  stored.folder = part.folder;
  stored.stamp = part.stamp;
  return stored;
}

void find_present(Part& part, const StoredCampaign& whole) {
  const auto take = [&](const ResultRow& row) {
    if (part.present.empty() || part.present.back().last != row.run)
      part.present.push_back({row.run, row.run});
    ++part.present.back().last;
  };
  (void)for_each_stored_row(stored_in(part, whole), take);
}

RunRange common(const RunRange& a, const RunRange& b) {
  return {std::max(a.first, b.first), std::min(a.last, b.last)};
}

/// A problem for each folder that has runs of those before it.
void find_doubles(const std::vector<Part>& parts, std::vector<Problem>& problems) {
  for (std::size_t p = 0; p < parts.size(); ++p) {
    RunList twice;
    std::string other;
    for (std::size_t q = 0; q < p; ++q)
      for (const RunRange& here : parts[p].present)
        for (const RunRange& there : parts[q].present)
          if (const RunRange both = common(here, there); both.size() > 0) {
            twice.add(both);
            other = parts[q].folder.string();
          }
    if (!twice.empty())
      problems.push_back({parts[p].folder.string(), "",
                          fmt::format("runs {}, which {} has too", twice.text(), other),
                          "each run in one folder"});
  }
}

/// What is left of the range.
/// @param present in order
RunList missing_in(const RunRange& range, const std::vector<RunRange>& present) {
  RunList missing;
  long next = range.first;
  for (const RunRange& there : present) {
    missing.add({next, std::min(there.first, range.last)});
    next = std::max(next, there.last);
  }
  missing.add({next, range.last});
  return missing;
}

/// A problem for each folder that lacks runs of its own, and one for runs that no folder should
/// have had.
void find_missing(const std::vector<Part>& parts, long runs, std::vector<Problem>& problems) {
  std::vector<RunRange> somebodys;
  for (const Part& part : parts) {
    somebodys.push_back(part.own);
    if (const RunList missing = missing_in(part.own, part.present); !missing.empty())
      problems.push_back(
          {part.folder.string(), "", fmt::format("no runs {}", missing.text()),
           fmt::format("{} complete (run it again with --resume)", describe(part.stamp.shard))});
  }
  std::ranges::sort(somebodys, {}, &RunRange::first);
  if (const RunList nobodys = missing_in({0, runs}, somebodys); !nobodys.empty())
    problems.push_back({"", "", fmt::format("no folder with runs {}", nobodys.text()),
                        fmt::format("folders with all of the campaign's {} runs", runs)});
}

/// Writes the rows in the order of their runs.
/// @param parts complete, and no run in two of them
void write_in_order(std::vector<Part> parts, const StoredCampaign& whole) {
  constexpr std::size_t block_bytes = 1 << 16;
  std::ranges::sort(parts, {}, [](const Part& part) { return part.own.first; });
  WholeFile out(whole.folder / runs_file);
  std::string lines;
  append_header(lines, RunPlan(whole.campaign).names());
  const auto take = [&](const ResultRow& row) {
    append_row(lines, row);
    if (lines.size() < block_bytes) return;
    out.write(lines);
    lines.clear();
  };
  for (const Part& part : parts) (void)for_each_stored_row(stored_in(part, whole), take);
  out.write(lines);
  out.finish();
}

/// An earlier merging of the same folders may have been cut off: it is done again.
void refuse_other_folder(const std::filesystem::path& out, const std::string& text) {
  if (read_text(out / campaign_file) != text)
    refuse_used_folder(out, "a new or an empty folder for the merged results");
}

/// What is to be merged, when nothing speaks against it.
struct Merging {
  StoredCampaign whole;
  std::vector<Part> parts;
  std::string campaign; ///< campaign.json's text
};

/// @throws SpecError with all that keeps the folders from being merged
Merging check_parts(const std::vector<std::filesystem::path>& folders,
                    const std::filesystem::path& out) {
  Merging merging;
  auto& [whole, parts, text] = merging;
  for (const auto& folder : folders) {
    StoredCampaign stored = read_stored_campaign(folder);
    parts.push_back({folder, stored.stamp, stored.runs()});
    if (parts.size() == 1) whole = std::move(stored);
  }
  refuse_strangers(parts);
  refuse_stopping(whole);
  whole.folder = out;
  whole.stamp.shard.reset();
  text = campaign_text(whole.campaign, whole.stamp);
  refuse_other_folder(out, text);
  std::vector<Problem> problems;
  for (Part& part : parts) find_present(part, whole);
  find_doubles(parts, problems);
  find_missing(parts, whole.campaign.sampling.runs, problems);
  if (!problems.empty()) throw SpecError(std::move(problems));
  return merging;
}

/// The folders of one case.
std::vector<std::filesystem::path> of_case(const std::vector<std::filesystem::path>& folders,
                                           const CaseSpec& spec) {
  std::vector<std::filesystem::path> its;
  for (const auto& folder : folders) its.push_back(folder / spec.name);
  return its;
}

} // namespace

Summary merge_folders(const std::vector<std::filesystem::path>& folders,
                      const std::filesystem::path& out) {
  auto [whole, parts, text] = check_parts(folders, out);
  const FolderLock lock(out);
  refuse_other_folder(out, text);
  write_file(out / campaign_file, text);
  write_in_order(std::move(parts), whole);
  return write_statistics(whole, read_stored_results(whole).results, whole.campaign.statistics);
}

std::vector<CaseSummary> merge_cases(const std::vector<std::filesystem::path>& folders,
                                     const std::filesystem::path& out) {
  std::vector<Part> parts;
  for (const auto& folder : folders)
    parts.push_back({folder, read_stored_campaign(folder).stamp, {}});
  refuse_strangers(parts);
  StoredCampaign whole = read_stored_campaign(folders.front());
  const std::vector<CaseSpec> made = made_cases(whole);
  whole.folder = out;
  whole.stamp.shard.reset();
  const std::string text = campaign_text(whole.campaign, whole.stamp);
  refuse_other_folder(out, text);
  for (const CaseSpec& spec : made)
    (void)check_parts(of_case(folders, spec), out / spec.name); // all before anything is written
  const FolderLock lock(out);
  refuse_other_folder(out, text);
  write_file(out / campaign_file, text);
  std::vector<CaseSummary> cases;
  for (const CaseSpec& spec : made) {
    Summary summary = merge_folders(of_case(folders, spec), out / spec.name);
    cases.push_back(case_summary(read_stored_campaign(out / spec.name), std::move(summary)));
  }
  write_cases_file(whole, cases, out);
  return cases;
}

} // namespace wingspread
