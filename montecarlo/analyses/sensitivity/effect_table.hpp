/// What the reports of both analyses have in common: effects of dispersions, with their bounds, in
/// JSON and in a table.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/statistics/bounds.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// The width of a dispersion's name in a table.
inline constexpr std::size_t name_width = 30;

/// {"value", "lower", "upper"}.
[[nodiscard]] Json value_json(double value, const Bounds& bounds);
/// "    0.123      0.056 … 0.345", 30 columns wide.
[[nodiscard]] std::string value_text(double value, const Bounds& bounds);

/// The line that heads an output's table, its two values named.
[[nodiscard]] std::string column_names(std::string_view first, std::string_view second,
                                       double confidence);

/// "root.latch_time, s · 90 runs · 10 without it left out", the last part where there are any.
[[nodiscard]] std::string heading_of(const std::string& output, long count,
                                     std::string_view counted, long missing,
                                     std::string_view what_of_them);

/// One output's heading and its first lines, the largest first; what is smaller is summed up in
/// one.
/// @param size of each of `count` dispersions, which it is sorted by; NaN comes last
/// @param line of each of them, with its line feed
[[nodiscard]] std::string effect_block(const std::string& heading, const std::string& columns,
                                       std::size_t count,
                                       const std::function<double(std::size_t)>& size,
                                       const std::function<std::string(std::size_t)>& line);

/// `"a", "b"`.
[[nodiscard]] std::string quoted(const std::vector<std::string>& names);

} // namespace wingspread
