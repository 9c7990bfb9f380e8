/// The resolution of the page: limits of its lists that keep its data below 3.5 MB for any campaign.
#pragma once

#include <cstddef>

namespace wingspread {

/// The quantities that the page's size depends on.
struct PageExtent {
  std::size_t sets = 1;
  std::size_t hinges = 1;  ///< the largest number in a set
  std::size_t outputs = 1; ///< the largest number in a set
};

/// The largest length of each list that grows with the scene or the number of sets (page/DATA.md).
struct PageDetail {
  std::size_t outputs = 400;           ///< of a set
  std::size_t bins = 80;               ///< of a histogram
  std::size_t knots = 129;             ///< of a distribution function
  std::size_t convergence_points = 40; ///< of a convergence
  std::size_t motions = 12;            ///< of a set
  std::size_t motion_samples = 400;    ///< of one run
  std::size_t envelope_times = 100;
  std::size_t envelope_runs = 200;
  std::size_t latch_times = 200; ///< of one hinge
  std::size_t scatters = 12;
  std::size_t effects = 12;           ///< on one output
  std::size_t correlated_draws = 100; ///< of the table of correlations
  std::size_t parameters = 1500;      ///< of the scene
};

/// The full lengths if the page's data stay below 3.5 MB with them. Else each part of the page gets a fixed share of
/// the 3.5 MB, and its lists are shortened to fit.
[[nodiscard]] PageDetail page_detail(const PageExtent& extent);

} // namespace wingspread
