/// The campaign's keys `sampling`, `integration`, `statistics` and `report`.
///
/// Each `read_` overwrites given keys only (the caller passes the defaults) and notes problems in the cursor's list;
/// each `write_` makes all values explicit.
#pragma once

#include "core/deployment.hpp"
#include "distributions/design.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/foundation/statistics/histogram.hpp"
#include "montecarlo/foundation/statistics/wilks.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// Most runs of a campaign, because statistics store ranks in 32 bits. (So many rows are about a terabyte of runs.csv.)
inline constexpr std::int64_t most_runs = (std::int64_t{1} << 31) - 1;

struct Sampling {
  DesignKind design = DesignKind::random;
  std::int64_t runs = 1000; ///< from 1 to most_runs
  std::uint64_t seed = 1;
  std::int64_t replicates = 1; ///< independent repetitions of a design, ≥ 1
  /// Numbers of runs of earlier interim analyses, before the campaign was extended: ascending, below `runs`.
  std::vector<std::int64_t> extended_from{};
};

/// Whether the design has replicates. Independent draws have none, whatever number is given.
[[nodiscard]] constexpr bool has_replicates(const Sampling& sampling) {
  return sampling.design != DesignKind::random;
}

[[nodiscard]] Design design_of(const Sampling& sampling);

inline constexpr std::array<std::string_view, 3> design_names{"random", "latin_hypercube", "sobol"};

/// Whether the method has a fixed step; other methods ignore `Integration::step`.
[[nodiscard]] bool has_fixed_step(std::string_view method);

inline constexpr std::array<std::string_view, 3> side_names{"upper", "lower", "both"};

/// Tolerance limits of every output: at least the share `probability` of all wings lies within them.
struct ToleranceLimitSpec {
  double probability = 0, confidence = 0; ///< each in (0, 1)
  Side side = Side::upper;
};

struct StatisticsSpec {
  std::vector<double> quantiles{0.01, 0.5, 0.99}; ///< probabilities, each in (0, 1), ascending
  double confidence = 0.95;                       ///< of every two-sided bound, in (0, 1)
  Bins bins = AutoBins{};
  std::vector<ToleranceLimitSpec> tolerance_limits{};
  /// Runs repeated to measure the integration error; nothing: as count_repeated (accuracy.hpp).
  std::optional<std::int64_t> accuracy_runs{};
};

/// The words on the first page of the report; each may be empty. Nothing depends on them.
struct ReportHeader {
  std::string title, author, organisation;
  std::string document; ///< its number
  std::string revision, date;
  bool operator==(const ReportHeader&) const = default;
};
/// A key of the block `report`, and an option of `wingspread report`.
struct HeaderWord {
  const char *key, *help;
  std::string ReportHeader::*member;
};
inline constexpr std::array header_words{
    HeaderWord{"title", "Title of the document", &ReportHeader::title},
    HeaderWord{"author", "Who answers for it", &ReportHeader::author},
    HeaderWord{"organisation", "Whose document it is", &ReportHeader::organisation},
    HeaderWord{"document", "Number of the document", &ReportHeader::document},
    HeaderWord{"revision", "Its revision", &ReportHeader::revision},
    HeaderWord{"date", "Its date, as given: the page has no other", &ReportHeader::date}};

void read_sampling(const JsonCursor& at, Sampling& sampling);
void read_integration(const JsonCursor& at, Integration& integration);
/// Features of this scene that smoothed latches lack: "a smoothed latch, and hinges.root.latch.backlash"; empty if none.
[[nodiscard]] std::string beyond_smoothed_latches(const Scene& scene);
inline constexpr const char* expected_event_latches =
    "\"event\": a smoothed latch knows no capture rate, holding moment or backlash";
void read_statistics(const JsonCursor& at, StatisticsSpec& statistics);
void read_report_header(const JsonCursor& at, ReportHeader& header);

[[nodiscard]] Json write_sampling(const Sampling& sampling);
[[nodiscard]] Json write_integration(const Integration& integration);
[[nodiscard]] Json write_statistics(const StatisticsSpec& statistics);
/// Without empty words.
[[nodiscard]] Json write_report_header(const ReportHeader& header);

} // namespace wingspread
