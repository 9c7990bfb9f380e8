/// The report: one HTML page that needs nothing but itself.
///
/// Its template and its scripts stand in page/, and page/DATA.md has the shape of the data in it.
#pragma once

#include "montecarlo/report/data/page_source.hpp"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace wingspread {

struct PageSources {
  std::vector<std::unique_ptr<PageSource>> runs; ///< sets of runs
  std::vector<Json> studies;                     ///< sets of folders that a study left, behind them
};

/// Reads folders of results: a set each or, of a campaign with cases, one for each case; and folders that `margin`,
/// `sensitivity` of a campaign or `rare` left.
/// @param threads as of thread_count (team.hpp)
/// @throws SpecError for what is none, is broken, or comes to more than 12 sets
[[nodiscard]] PageSources read_page_sources(std::span<const std::filesystem::path> folders,
                                            int threads);

/// The page's block of data.
/// @param command that makes the page
[[nodiscard]] Json page_json(const PageSources& sources, const std::string& command, int threads);

/// The page. The same folders give the same bytes, whatever the number of threads.
[[nodiscard]] std::string html_page(const Json& data);

} // namespace wingspread
