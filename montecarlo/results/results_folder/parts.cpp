#include "montecarlo/results/results_folder/parts.hpp"

#include "montecarlo/foundation/formats/json_parse.hpp"
#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/foundation/platform/folder_lock.hpp"
#include "montecarlo/results/results_folder/differences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

namespace wingspread {
namespace {

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

RunRange common(const RunRange& a, const RunRange& b) {
  return {std::max(a.first, b.first), std::min(a.last, b.last)};
}

/// The runs of the range that are missing.
/// @param present increasing
std::vector<RunRange> missing_in(const RunRange& range, const std::vector<RunRange>& present) {
  std::vector<RunRange> missing;
  const auto add = [&](long first, long last) {
    if (first < last) missing.push_back({first, last});
  };
  long next = range.first;
  for (const RunRange& there : present) {
    add(next, std::min(there.first, range.last));
    next = std::max(next, there.last);
  }
  add(next, range.last);
  return missing;
}

RunList listed(const std::vector<RunRange>& ranges) {
  RunList list;
  for (const RunRange& range : ranges) list.add(range);
  return list;
}

/// "part2" → "part3": the folder's name with another shard's number, if the name has its own.
std::optional<std::filesystem::path> renumbered(const Part& part, long index) {
  const std::string name = part.out.filename().string(),
                    own = std::to_string(part.stamp.shard->index);
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const std::size_t at = name.find(own), behind = at + own.size();
  if (at == std::string::npos || name.find(own, behind) != std::string::npos) return std::nullopt;
  if ((at > 0 && is_digit(name[at - 1])) || (behind < name.size() && is_digit(name[behind])))
    return std::nullopt;
  return part.out.parent_path() /
         (name.substr(0, at) + std::to_string(index) + name.substr(behind));
}

std::string command(const ShardMaker& maker, const std::filesystem::path& out,
                    const std::optional<Shard>& shard, bool resume) {
  std::string text = maker.command + " --out " + shell_word(out.string());
  if (shard) text += fmt::format(" --shard {}/{}", shard->index, shard->of);
  return text + maker.more + (resume ? " --resume" : "");
}

/// A new name beside a shard's folder.
std::filesystem::path folder_beside(const Part& sibling, const Shard& shard) {
  return sibling.out.parent_path() / fmt::format("shard_{}_of_{}", shard.index, shard.of);
}

/// The command for a shard without a folder. If a folder of that name exists, the command resumes it.
std::string command_for(const ShardMaker& maker, const Part& sibling, const Shard& shard) {
  const std::filesystem::path out =
      renumbered(sibling, shard.index).value_or(folder_beside(sibling, shard));
  return command(maker, out, shard, std::filesystem::exists(out));
}

/// The first of so many shards that does not begin before the run.
Shard first_shard_from(long run, long runs, long of) {
  return {(run * of + runs - 1) / runs + 1, of};
}

/// The largest shard that begins with the first of the missing runs and has no others; nothing if none does.
std::optional<Shard> largest_shard_in(const RunRange& missing, long runs) {
  for (long of = std::max(1L, runs / missing.size()); of <= std::min(runs, most_shards); ++of) {
    const Shard shard = first_shard_from(missing.first, runs, of);
    const RunRange own = shard_runs(runs, shard);
    if (own.first == missing.first && own.size() > 0 && own.last <= missing.last) return shard;
  }
  return std::nullopt;
}

/// Adds a command for each shard that lies within the missing runs. Considers the numbers of shards that the existing
/// folders use; for runs between shards of different numbers, others.
void add_commands(const std::vector<Part>& parts, const std::vector<RunRange>& missing_ranges,
                  long runs, const ShardMaker& maker, PartFaults& faults) {
  std::map<long, const Part*, std::greater<>> siblings; // a folder for each number of shards in use
  for (const Part& part : parts)
    if (part.stamp.shard) siblings.try_emplace(part.stamp.shard->of, &part);
  for (const RunRange& missing : missing_ranges) {
    long next = missing.first; // first run that no command makes yet
    for (const auto& [of, sibling] : siblings)
      for (Shard shard = first_shard_from(next, runs, of); shard.index <= of && next < missing.last;
           ++shard.index) {
        const RunRange own = shard_runs(runs, shard);
        if (own.first > next) break;
        if (own.size() == 0 || own.last > missing.last) continue;
        faults.add(command_for(maker, *sibling, shard));
        next = own.last;
      }
    while (!siblings.empty() && next < missing.last) {
      const std::optional<Shard> shard = largest_shard_in({next, missing.last}, runs);
      if (!shard) break;
      const auto out = folder_beside(*siblings.begin()->second, *shard);
      faults.add(command(maker, out, shard, std::filesystem::exists(out)));
      next = shard_runs(runs, *shard).last;
    }
  }
}

} // namespace

void Part::add(long run) {
  if (present.empty() || present.back().last != run) present.push_back({run, run});
  ++present.back().last;
}

long Part::count() const {
  long count = 0;
  for (const RunRange& range : present) count += range.size();
  return count;
}

void PartFaults::add(Problem problem) {
  if (known_.insert(to_string(problem)).second) problems_.push_back(std::move(problem));
}

void PartFaults::add(std::string command) {
  if (known_.insert(command).second) commands_.push_back(std::move(command));
}

void PartFaults::refuse() const {
  if (!commands_.empty()) throw MissingRuns(problems_, commands_, can_preview_);
  if (!problems_.empty()) throw SpecError(problems_);
}

namespace {

/// Names the values in which the part's campaign differs from the first one; the hashes if only the order of keys does.
void tell_differences(const Part& part, const Part& first, const char* file,
                      std::vector<Problem>& problems) {
  const auto document = [&](const Part& of) {
    Json json = parse_json_file(of.folder / file);
    json.erase(stamp_key);
    return json;
  };
  const Json its = document(part), ours = document(first);
  const std::vector<Difference> all = find_differences(its, ours);
  const std::string path = (part.folder / file).string(),
                    as_in = ", as in " + first.folder.string();
  for (std::size_t i = 0; i < std::min(all.size(), most_differences); ++i)
    problems.push_back({path, all[i].pointer, describe_or_nothing(all[i].found),
                        describe_or_nothing(all[i].expected) + as_in});
  if (all.empty() || all.size() > most_differences)
    problems.push_back({path, "/wingspread/hash", part.stamp.hash,
                        fmt::format("{}{}: {}", first.stamp.hash, as_in,
                                    all.empty() ? "the same values in another order"
                                                : fmt::format("{} values differ", all.size()))});
}

/// The process that is at work in the part's folder, or in that of all cases; empty: none.
std::string holder_of_part(const Part& part) {
  const std::string holder = holder_of(part.folder);
  return holder.empty() ? holder_of(part.out) : holder;
}

/// Advice before a part with a gap between its rows is resumed; empty if only the last rows are missing.
std::string gap_advice(const Part& part, const RunRange& missing) {
  if (part.present.empty() || missing.first > part.present.back().first) return "";
  return fmt::format("rows were removed: delete all rows from run {} on, then ", missing.last);
}

} // namespace

void refuse_other_campaigns(const std::vector<Part>& parts, const char* file) {
  const Part& first = parts.front();
  std::vector<Problem> problems;
  for (const Part& part : parts) {
    const std::string path = (part.folder / file).string();
    const auto compare = [&](const char* key, const std::string& found, const std::string& ours) {
      if (found != ours)
        problems.push_back({path, fmt::format("/wingspread/{}", key), found,
                            fmt::format("{}, as in {}", ours, first.folder.string())});
    };
    if (part.stamp.hash != first.stamp.hash) tell_differences(part, first, file, problems);
    compare("version", part.stamp.version, first.stamp.version);
    if (part.stamp.preview)
      problems.push_back({path, "/wingspread/preview", describe(*part.stamp.preview),
                          "shards: what is merged has each run once"});
  }
  if (!problems.empty()) throw SpecError(std::move(problems));
}

void find_doubles(const std::vector<Part>& parts, PartFaults& faults) {
  struct Owned {
    RunRange runs;
    std::size_t part;
  };
  std::vector<Owned> all;
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (const RunRange& runs : parts[p].present) all.push_back({runs, p});
  std::ranges::stable_sort(all, {}, [](const Owned& each) { return each.runs.first; });
  std::map<std::pair<std::size_t, std::size_t>, RunList> twice; // the later folder first
  std::vector<Owned> open;                                      // those that reach the next one
  for (const Owned& here : all) {
    std::erase_if(open, [&](const Owned& each) { return each.runs.last <= here.runs.first; });
    for (const Owned& there : open)
      twice[std::minmax(here.part, there.part, std::greater{})].add(common(here.runs, there.runs));
    open.push_back(here);
  }
  for (const auto& [both, runs] : twice)
    faults.add(Problem{
        parts[both.first].folder.string(), "",
        fmt::format("runs {}, which {} has too", runs.text(), parts[both.second].folder.string()),
        "each run in one folder: shards of one division, as 1/N to N/N"});
  if (!twice.empty()) faults.forbid_preview();
}

void find_missing(const std::vector<Part>& parts, long runs, const ShardMaker& maker,
                  PartFaults& faults) {
  if (std::ranges::all_of(parts, [](const Part& part) { return part.present.empty(); }))
    faults.forbid_preview();
  std::vector<RunRange> present;
  for (const Part& part : parts) {
    present.push_back(part.own);
    const std::vector<RunRange> missing = missing_in(part.own, part.present);
    if (missing.empty()) continue;
    if (const std::string holder = holder_of_part(part); !holder.empty()) {
      faults.add(Problem{
          part.folder.string(), "",
          fmt::format("no runs {} yet: {} is at work in it", listed(missing).text(), holder),
          describe(part.stamp.shard) + " complete (wait until that process ends)"});
      continue;
    }
    faults.add(Problem{part.folder.string(), "", fmt::format("no runs {}", listed(missing).text()),
                       fmt::format("{} complete ({}run it again with --resume)",
                                   describe(part.stamp.shard), gap_advice(part, missing.front()))});
    faults.add(command(maker, part.out, part.stamp.shard, true));
  }
  std::ranges::sort(present, {}, &RunRange::first);
  const std::vector<RunRange> missing_ranges = missing_in({0, runs}, present);
  if (missing_ranges.empty()) return;
  faults.add(Problem{"", "", fmt::format("no folder with runs {}", listed(missing_ranges).text()),
                     fmt::format("folders with all of the campaign's {} runs", runs)});
  add_commands(parts, missing_ranges, runs, maker, faults);
}

} // namespace wingspread
