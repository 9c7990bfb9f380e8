#include "montecarlo/report/data/differences.hpp"

#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "montecarlo/foundation/statistics/replicate_bounds.hpp"
#include "montecarlo/foundation/statistics/two_sided.hpp"
#include "montecarlo/report/data/page_numbers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace wingspread {
namespace {

constexpr Difference none{undefined, {}, 0};

Difference with_width(double value, double error, double degrees, double confidence, long runs) {
  if (!(degrees >= 1) || !std::isfinite(error)) return {value, {}, runs};
  const double width = two_sided_student(static_cast<long>(degrees), confidence) * error;
  return {value, {{value - width}, {value + width}}, runs};
}

/// The difference b − a, with bounds from the bounds of a and b.
Difference of_shares(double value, const Interval& a, const Interval& b, long runs) {
  return {value, {b.lower - a.upper, b.upper - a.lower}, runs};
}

Json difference_json(const char* key, const std::string& name, const Difference& difference) {
  Json json{{key, name}, {"difference", page_number(difference.value)}};
  add_bounds(json, difference.bounds);
  json["runs"] = difference.runs;
  return json;
}

bool has_negative(const Column& column) {
  return std::ranges::any_of(column.values, [](double value) { return value < 0; });
}

Column magnitudes(const Column& column) {
  Column sizes{column.name, {}};
  for (const double value : column.values) sizes.values.push_back(std::abs(value));
  return sizes;
}

/// The values that are numbers.
std::vector<double> present(const Column& column) {
  std::vector<double> values;
  std::ranges::copy_if(column.values, std::back_inserter(values),
                       [](double value) { return !std::isnan(value); });
  return values;
}

/// Two sets and, if paired, their common rows.
struct Sides {
  const PageSource &first, &second;
  bool paired;
  SameRuns rows;
  double confidence = 0; ///< of each bound: the higher of the sets'
};

/// The difference of an output's columns in both sets.
Difference output_difference(const Sides& sides, const Column& first, const Column& second) {
  if (sides.paired)
    return paired_difference(first, second, sides.rows, sides.first.replication, sides.confidence);
  Difference difference =
      unpaired_difference(moments(present(first)), moments(present(second)), sides.confidence);
  if (sides.first.replication.replicates + sides.second.replication.replicates > 0)
    difference.bounds = {};
  return difference;
}

/// @param mean of the first set
Json entry_of(const std::string& name, const Difference& difference, double mean) {
  Json entry = difference_json("output", name, difference);
  entry["relative"] = page_number(mean == 0 ? undefined : difference.value / std::abs(mean));
  return entry;
}

/// The difference of the means by their moments alone. An output without positive values is compared by its magnitude.
Json entry_of_moments(const Sides& sides, const OutputSummary& first, const OutputSummary& second) {
  Moments a = first.moments, b = second.moments;
  const bool magnitude = (a.min < 0 || b.min < 0) && !(a.max > 0) && !(b.max > 0);
  if (magnitude) a.mean = -a.mean, b.mean = -b.mean;
  Json entry = entry_of(first.name, unpaired_difference(a, b, sides.confidence), a.mean);
  entry["magnitude"] = magnitude;
  return entry;
}

/// The differences of all outputs; of an output with negative values those of the magnitudes, because the hinges of
/// mirrored wings turn in opposite senses.
Json outputs_difference_json(const Sides& sides) {
  Json json = Json::array();
  const auto& others = sides.second.results.outputs;
  for (std::size_t i = 0; i < sides.first.results.outputs.size(); ++i) {
    const Column& column = sides.first.results.outputs[i];
    const auto other = std::ranges::find(others, column.name, &Column::name);
    if (other == others.end()) continue;
    const OutputSummary& summary = sides.first.summary.outputs[i];
    if (!sides.first.has_rows() || !sides.second.has_rows()) {
      json.push_back(entry_of_moments(
          sides, summary,
          sides.second.summary.outputs[static_cast<std::size_t>(other - others.begin())]));
      continue;
    }
    const bool magnitude = has_negative(column) || has_negative(*other);
    if (magnitude) {
      const Column first = magnitudes(column), second = magnitudes(*other);
      json.push_back(entry_of(column.name, output_difference(sides, first, second),
                              moments(present(first)).mean));
    } else {
      json.push_back(
          entry_of(column.name, output_difference(sides, column, *other), summary.moments.mean));
    }
    json.back()["magnitude"] = magnitude;
  }
  return json;
}

Difference status_difference(const Sides& sides, std::size_t status) {
  if (!sides.paired)
    return unpaired_share_difference(
        sides.first.summary.statuses[status].count, sides.first.summary.runs,
        sides.second.summary.statuses[status].count, sides.second.summary.runs, sides.confidence);
  long first_alone = 0, second_alone = 0;
  for (std::size_t k = 0; k < sides.rows.first.size(); ++k) {
    const bool in_first = sides.first.results.status[sides.rows.first[k]] == statuses[status];
    const bool in_second = sides.second.results.status[sides.rows.second[k]] == statuses[status];
    first_alone += in_first && !in_second;
    second_alone += in_second && !in_first;
  }
  return paired_share_difference(first_alone, second_alone, std::ssize(sides.rows.first),
                                 sides.confidence);
}

/// Why the sets are not paired; empty if they are.
std::string why_unpaired(const Sides& sides) {
  if (sides.paired) return "";
  if (!sides.first.has_rows() || !sides.second.has_rows()) return "rows were not kept";
  return have_same_draws(sides.first, sides.second) ? "the sets have no run in common"
                                                    : "their seeds, designs or dispersions differ";
}

/// Says in words which runs are compared.
std::string runs_text(const Sides& sides) {
  const long first = sides.first.summary.runs, second = sides.second.summary.runs,
             both = std::ssize(sides.rows.first);
  if (!sides.paired)
    return fmt::format("not paired, because {}: {} and {} runs", why_unpaired(sides), second,
                       first);
  const std::string of =
      both == first && both == second ? "" : fmt::format(" (of {} and {})", second, first);
  return fmt::format("run by run over the {} runs with the same random numbers{}", both, of);
}

using Sets = std::span<const std::unique_ptr<PageSource>>;

/// The set of a folder with the same case; nothing if there is none.
std::optional<std::size_t> partner_of(Sets sets, std::size_t set,
                                      const std::vector<std::size_t>& folder) {
  for (const std::size_t other : folder)
    if (sets[other]->stored.campaign.of_case == sets[set]->stored.campaign.of_case) return other;
  return std::nullopt;
}

void note_missing(Sets sets, const std::vector<std::size_t>& folder,
                  const std::vector<std::size_t>& others, Pairs& pairs) {
  for (const std::size_t set : folder) {
    if (partner_of(sets, set, others)) continue;
    const std::string& name = sets[set]->stored.campaign.of_case;
    std::vector<std::string> labels;
    for (const std::size_t other : others) labels.push_back(sets[other]->label);
    pairs.missing.push_back(fmt::format("{}: none of {} is {}", sets[set]->label,
                                        fmt::join(labels, ", "),
                                        name.empty() ? "without a case" : "the case " + name));
  }
}

void pair_folders(Sets sets, const std::vector<std::size_t>& first,
                  const std::vector<std::size_t>& second, Pairs& pairs) {
  if (first.size() == 1 && second.size() == 1)
    return void(pairs.both.emplace_back(first.front(), second.front()));
  for (const std::size_t set : second)
    if (const auto partner = partner_of(sets, set, first)) pairs.both.emplace_back(*partner, set);
  note_missing(sets, first, second, pairs);
  note_missing(sets, second, first, pairs);
}

Json statuses_difference_json(const Sides& sides) {
  const bool replicated =
      sides.first.replication.replicates + sides.second.replication.replicates > 0;
  Json json = Json::array();
  for (std::size_t i = 0; i < statuses.size(); ++i) {
    Difference difference = status_difference(sides, i);
    if (replicated) difference.bounds = {};
    json.push_back(difference_json("status", to_string(statuses[i]), difference));
  }
  return json;
}

} // namespace

SameRuns same_runs(const Results& first, const Results& second) {
  SameRuns rows;
  for (std::size_t i = 0, j = 0; i < first.size() && j < second.size();) {
    if (first.runs[i] == second.runs[j]) {
      rows.first.push_back(i);
      rows.second.push_back(j);
    }
    const bool step_second = second.runs[j] <= first.runs[i];
    i += first.runs[i] <= second.runs[j];
    j += step_second;
  }
  return rows;
}

Difference paired_difference(const Column& first, const Column& second, const SameRuns& rows,
                             const Replication& replication, double confidence) {
  std::vector<double> differences;
  std::vector<ReplicateValue> replicated;
  for (std::size_t k = 0; k < rows.first.size(); ++k) {
    const double difference = second.values[rows.second[k]] - first.values[rows.first[k]];
    if (std::isnan(difference)) continue;
    differences.push_back(difference);
    if (replication.replicates > 0)
      replicated.push_back({difference, replication.of_row[rows.first[k]]});
  }
  if (differences.empty()) return none;
  const Moments all = moments(differences);
  if (replication.replicates > 0)
    return with_width(all.mean, replicate_mean_error(replicated, replication.replicates, all.mean),
                      replication.replicates - 1, confidence, all.count);
  return with_width(all.mean, all.std / std::sqrt(static_cast<double>(all.count)),
                    static_cast<double>(all.count - 1), confidence, all.count);
}

Difference unpaired_difference(const Moments& first, const Moments& second, double confidence) {
  if (first.count == 0 || second.count == 0) return none;
  const auto variance = [](const Moments& m) {
    return m.std * m.std / static_cast<double>(m.count);
  };
  const double a = variance(first), b = variance(second), sum = a + b;
  const auto degrees_of = [](double part, long count) {
    return part * part / static_cast<double>(count - 1);
  };
  const double degrees =
      sum > 0 ? sum * sum / (degrees_of(a, first.count) + degrees_of(b, second.count))
              : static_cast<double>(std::min(first.count, second.count) - 1);
  return with_width(second.mean - first.mean, std::sqrt(sum), degrees, confidence,
                    std::min(first.count, second.count));
}

Difference paired_share_difference(long first_alone, long second_alone, long n, double confidence) {
  if (n == 0) return none;
  const double each = (1 + confidence) / 2; // 1 − α/2
  return of_shares(static_cast<double>(second_alone - first_alone) / static_cast<double>(n),
                   clopper_pearson(first_alone, n, each), clopper_pearson(second_alone, n, each),
                   n);
}

Difference unpaired_share_difference(long first, long first_of, long second, long second_of,
                                     double confidence) {
  if (first_of == 0 || second_of == 0) return none;
  const double each = (1 + confidence) / 2;
  const auto share = [](long hits, long n) {
    return static_cast<double>(hits) / static_cast<double>(n);
  };
  return of_shares(share(second, second_of) - share(first, first_of),
                   clopper_pearson(first, first_of, each), clopper_pearson(second, second_of, each),
                   std::min(first_of, second_of));
}

bool have_same_draws(const PageSource& first, const PageSource& second) {
  const Results &a = first.results, &b = second.results;
  const Sampling &sampled = first.stored.campaign.sampling,
                 &other = second.stored.campaign.sampling;
  const bool fixed_design = sampled.design == DesignKind::random || sampled.runs == other.runs;
  return !first.stored.foreign && !second.stored.foreign && sampled.seed == other.seed &&
         sampled.design == other.design && sampled.replicates == other.replicates && fixed_design &&
         std::ranges::is_permutation(a.draws, b.draws, {}, &Column::name, &Column::name);
}

Pairs pairs_of(std::span<const std::unique_ptr<PageSource>> sets) {
  std::vector<std::vector<std::size_t>> folders; // the sets of each folder
  for (std::size_t k = 0; k < sets.size(); ++k) {
    if (k == 0 || sets[k]->argument != sets[k - 1]->argument) folders.emplace_back();
    folders.back().push_back(k);
  }
  Pairs pairs;
  for (std::size_t k = 1; k < folders.size(); ++k) {
    pair_folders(sets, folders.front(), folders[k], pairs);
    if (k > 1) pair_folders(sets, folders[k - 1], folders[k], pairs);
  }
  for (const std::vector<std::size_t>& cases : folders)
    for (std::size_t k = 1; k < cases.size(); ++k) {
      pairs.both.emplace_back(cases.front(), cases[k]);
      if (k > 1) pairs.both.emplace_back(cases[k - 1], cases[k]);
    }
  return pairs;
}

Json comparison_json(const PageSource& first, const PageSource& second,
                     std::pair<std::size_t, std::size_t> places) {
  Sides sides{first,
              second,
              first.has_rows() && second.has_rows() && have_same_draws(first, second),
              {},
              std::max(first.confidence, second.confidence)};
  if (sides.paired) sides.rows = same_runs(first.results, second.results);
  if (sides.rows.first.empty()) sides.paired = false;
  return {{"sets", {places.first, places.second}},
          {"folders", first.argument != second.argument},
          {"paired", sides.paired},
          {"why_unpaired", sides.paired ? Json(nullptr) : Json(why_unpaired(sides))},
          {"runs", sides.paired ? Json(sides.rows.first.size()) : Json(nullptr)},
          {"text", fmt::format("{} − {}, {}", second.label, first.label, runs_text(sides))},
          {"confidence", sides.confidence},
          {"outputs", outputs_difference_json(sides)},
          {"statuses", statuses_difference_json(sides)}};
}

} // namespace wingspread
