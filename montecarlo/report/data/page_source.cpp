#include "montecarlo/report/data/page_source.hpp"

#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/results/streaming/streaming_folder.hpp"
#include "montecarlo/results/streaming/streaming_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

namespace wingspread {
namespace {

void read_rows(PageSource& source, int threads) {
  source.results = std::move(read_stored_results(source.stored).results);
  source.replication = replication_of(source.stored.campaign.sampling, source.results);
  source.summary = stored_summary(source.stored, source.results, threads);
  source.orders = std::make_unique<OrderSplit>(source.results, source.stored.campaign.scene);
}

void read_streaming(PageSource& source) {
  StoredStatistics read = read_streaming_statistics(source.stored);
  source.streaming = std::make_unique<StreamingStatistics>(std::move(read.statistics));
  source.results = read_broken_runs(source.stored, read.broken_bytes);
  source.summary =
      streaming_summary(source.stored, *source.streaming, source.stored.campaign.statistics);
  source.orders =
      std::make_unique<OrderSplit>(source.streaming->latch_orders(),
                                   source.streaming->other_orders(), source.stored.campaign.scene);
}

/// The worst value of the runs that deployed, if it is kept.
std::optional<JudgedRun> worst_kept(const StreamingStatistics& statistics,
                                    const Requirement& requirement) {
  for (std::size_t q = 0; q < statistics.required().size(); ++q) {
    const RequiredOutput& required = statistics.required()[q];
    const Population& values = statistics.required_values()[q].values;
    if (required.output != requirement.output || required.absolute != requirement.absolute ||
        required.column >= statistics.outputs().size() || values.count() == 0)
      continue;
    const RunValue worst = (requirement.min ? values.lowest() : values.highest()).sorted().front();
    return JudgedRun{worst.run, worst.value};
  }
  return std::nullopt;
}

std::string requirements_of(const PageSource& source, const std::filesystem::path& folder) {
  return source.stored.own_requirements
             ? " --requirements " + shell_word((folder / summary_file).string())
             : "";
}

} // namespace

std::string requirements_option(const PageSource& source) {
  return requirements_of(source, source.stored.folder);
}

std::string analysis_options(const PageSource& source) {
  std::string options = requirements_of(source, source.analyzed_in);
  const StatisticsSpec& asked = source.stored.campaign.statistics;
  const Json now = write_statistics(asked),
             own = source.stored.campaign.resolved.at("statistics"); // as before `analyze`
  const auto differs = [&](const char* key) { return now.at(key) != own.at(key); };
  if (differs("quantiles"))
    options += fmt::format(" --quantiles {}", fmt::join(asked.quantiles, ","));
  if (differs("confidence")) options += fmt::format(" --confidence {}", asked.confidence);
  if (differs("bins")) {
    const int* const count = std::get_if<int>(&asked.bins);
    options += " --bins " + (count ? std::to_string(*count) : "auto");
  }
  return options;
}

BrokenRuns broken_runs_of(const PageSource& source, const Verdict& verdict, std::size_t most) {
  BrokenRuns broken = broken_runs(verdict, source.results, most);
  if (source.has_rows()) return broken;
  const double sign = sign_of(verdict.requirement);
  const auto kept = worst_kept(*source.streaming, verdict.requirement);
  if (kept && (!broken.worst || sign * kept->value > sign * broken.worst->value))
    broken.worst = kept;
  return broken;
}

std::unique_ptr<PageSource> read_page_source(StoredCampaign stored, const std::string& label,
                                             const Campaign* before_case, int threads) {
  auto source = std::make_unique<PageSource>();
  source->label = label;
  source->before_case = before_case ? *before_case : stored.campaign;
  if (stored.own_requirements) source->before_case.requirements = stored.campaign.requirements;
  source->stored = std::move(stored);
  source->made_from = source->analyzed_in = source->stored.folder;
  if (is_streaming_folder(source->stored.folder))
    read_streaming(*source);
  else
    read_rows(*source, threads);
  source->confidence = source->summary.confidence_of_bound();
  return source;
}

} // namespace wingspread
