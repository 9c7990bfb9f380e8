#include "montecarlo/folder/merge.hpp"

#include "montecarlo/folder/folder_writer.hpp"
#include "montecarlo/formats/files.hpp"

#include <fmt/format.h>

#include <ostream>
#include <string>
#include <utility>

namespace wingspread {
namespace {

/// A folder and its rows.
struct Part {
  StoredCampaign stored;
  Results results;
};

/// Where a run's row is: in which part, and there in which row.
struct Place {
  std::ptrdiff_t part = -1;
  std::size_t row = 0;
};

/// "runs 3 to 5, 8": for messages.
class RunList {
public:
  void add(long run) {
    if (!ranges_.empty() && ranges_.back().last == run)
      ++ranges_.back().last;
    else if (ranges_.size() <= most) // one more than are shown
      ranges_.push_back({run, run + 1});
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
  const Stamp& first = parts.front().stored.stamp;
  const std::string name = parts.front().stored.folder.string();
  std::vector<Problem> problems;
  for (const auto& [stored, results] : parts) {
    const auto compare = [&](const char* key, const std::string& found, const std::string& ours) {
      if (found != ours)
        problems.push_back({(stored.folder / campaign_file).string(),
                            fmt::format("/wingspread/{}", key), found,
                            fmt::format("{}, as in {}", ours, name)});
    };
    compare("hash", stored.stamp.hash, first.hash);
    compare("version", stored.stamp.version, first.version);
  }
  if (!problems.empty()) throw SpecError(std::move(problems));
}

void refuse_stopping(const StoredCampaign& stored) {
  if (!stored.campaign.until.empty())
    throw SpecError({{(stored.folder / campaign_file).string(), "/until",
                      "a campaign that stops at a width", "one that can have shards"}});
}

/// The place of each run; a problem for each folder that has runs of those before it.
Spilled<Place> find_places(const std::vector<Part>& parts, std::vector<Problem>& problems) {
  Spilled<Place> places(static_cast<std::size_t>(parts.front().stored.campaign.sampling.runs), {});
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const auto& [stored, results] = parts[p];
    RunList twice;
    std::string other;
    for (std::size_t row = 0; row < results.size(); ++row) {
      Place& place = places[static_cast<std::size_t>(results.runs[row])];
      if (place.part >= 0) {
        twice.add(results.runs[row]);
        other = parts[static_cast<std::size_t>(place.part)].stored.folder.string();
      } else {
        place = {static_cast<std::ptrdiff_t>(p), row};
      }
    }
    results.runs.release();
    places.release();
    if (!twice.empty())
      problems.push_back({stored.folder.string(), "",
                          fmt::format("runs {}, which {} has too", twice.text(), other),
                          "each run in one folder"});
  }
  return places;
}

/// A problem for each folder that lacks runs of its own, and one for runs that no folder should
/// have had.
void find_missing(const std::vector<Part>& parts, const Spilled<Place>& places,
                  std::vector<Problem>& problems) {
  std::vector<bool> somebodys(places.size(), false);
  for (const auto& [stored, results] : parts) {
    const auto [first, last] = stored.runs();
    RunList missing;
    for (long run = first; run < last; ++run) {
      somebodys[static_cast<std::size_t>(run)] = true;
      if (places[static_cast<std::size_t>(run)].part < 0) missing.add(run);
    }
    if (!missing.empty())
      problems.push_back(
          {stored.folder.string(), "", fmt::format("no runs {}", missing.text()),
           fmt::format("{} complete (run it again with --resume)", describe(stored.stamp.shard))});
  }
  RunList nobodys;
  for (std::size_t run = 0; run < places.size(); ++run)
    if (!somebodys[run]) nobodys.add(static_cast<long>(run));
  if (!nobodys.empty())
    problems.push_back({"", "", fmt::format("no folder with runs {}", nobodys.text()),
                        fmt::format("folders with all of the campaign's {} runs", places.size())});
}

/// Writes the rows in the order of their runs. @return their table
Results write_in_order(const std::vector<Part>& parts, const Spilled<Place>& places,
                       const ResultNames& names, std::ostream& out) {
  constexpr std::size_t rows_held = 10'000;
  Results all(names);
  std::string lines;
  append_header(lines, names);
  for (std::size_t run = 0; run < places.size(); ++run) {
    const auto& [part, row] = places[run];
    const Results& results = parts[static_cast<std::size_t>(part)].results;
    const ResultRow made = results.row(row);
    append_row(lines, made);
    all.append(made);
    if (run % rows_held != 0) continue;
    out << lines;
    lines.clear();
    places.release();
    for (const Part& each : parts) each.results.release();
  }
  out << lines;
  return all;
}

} // namespace

Summary merge_folders(const std::vector<std::filesystem::path>& folders,
                      const std::filesystem::path& out) {
  refuse_used_folder(out, "a new or an empty folder for the merged results");
  std::vector<Part> parts;
  for (const auto& folder : folders) {
    StoredCampaign stored = read_stored_campaign(folder);
    Results results = read_stored_results(stored).results;
    parts.push_back({std::move(stored), std::move(results)});
  }
  refuse_strangers(parts);
  refuse_stopping(parts.front().stored);
  std::vector<Problem> problems;
  const Spilled<Place> places = find_places(parts, problems);
  find_missing(parts, places, problems);
  if (!problems.empty()) throw SpecError(std::move(problems));

  StoredCampaign whole = parts.front().stored;
  whole.folder = out;
  whole.stamp.shard.reset();
  const ResultNames names = RunPlan(whole.campaign).names();
  make_folder(out);
  write_file(out / campaign_file, campaign_text(whole.campaign, whole.stamp));
  Results all;
  write_file(out / runs_file,
             [&](std::ostream& file) { all = write_in_order(parts, places, names, file); });
  parts.clear();
  return write_statistics(whole, all, whole.campaign.statistics);
}

} // namespace wingspread
