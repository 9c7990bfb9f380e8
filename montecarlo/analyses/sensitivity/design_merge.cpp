#include "montecarlo/analyses/sensitivity/design_merge.hpp"

#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/results/results_folder/folder_writer.hpp"
#include "montecarlo/results/results_folder/parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace wingspread {
namespace {

/// Refuses a folder with content, unless it is an interrupted merge of the same design, which is then repeated.
void refuse_other_folder(const std::filesystem::path& out, const SaltelliDesign& whole) {
  if (read_text(out / design_file) != design_text(whole))
    refuse_used_folder(out, "a new or an empty folder for the merged runs");
  if (std::filesystem::exists(out / sensitivity_csv_file)) // written last
    throw SpecError(
        {{out.string(), "", "these shards, merged already",
          fmt::format("another --out; `wingspread sensitivity {}` makes its tables again",
                      shell_word(out.string()))}});
}

void refuse_other_bounds(const std::filesystem::path& folder, const SaltelliDesign& design,
                         const SaltelliDesign& first) {
  if (design.bounds != first.bounds)
    throw SpecError({{(folder / design_file).string(), "/bounds",
                      "another --resamples or --confidence than in the first shard",
                      "shards made by the same options"}});
}

} // namespace

void merge_designs(const std::vector<std::filesystem::path>& folders,
                   const std::filesystem::path& out) {
  SaltelliDesign whole = read_design(folders.front());
  std::vector<Part> parts;
  for (const std::filesystem::path& folder : folders) {
    const SaltelliDesign design = read_design(folder);
    refuse_other_bounds(folder, design, whole);
    parts.push_back({folder, folder, stamp_of(design), runs_of(design)});
  }
  refuse_other_campaigns(parts, design_file);
  whole.shard.reset();
  refuse_other_folder(out, whole);
  const RunPlan plan = saltelli_plan(whole.campaign, whole.rows);
  for (Part& part : parts)
    (void)for_each_design_row(part.folder, plan, part.own,
                              [&](const ResultRow& row) { part.add(row.run); });
  PartFaults faults;
  find_doubles(parts, faults);
  find_missing(
      parts, runs_of(whole).last,
      {"wingspread sensitivity " + shell_word((folders.front() / design_file).string()), ""},
      faults);
  faults.refuse();
  const FolderLock lock(out);
  refuse_other_folder(out, whole);
  write_file(out / design_file, design_text(whole));
  write_in_order(std::move(parts), plan.names(), out / design_runs_file,
                 [&](const Part& part, const auto& take) {
                   (void)for_each_design_row(part.folder, plan, part.own, take);
                 });
}

} // namespace wingspread
