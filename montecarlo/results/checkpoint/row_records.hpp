/// Rows of results as records of bytes, exact to the bit.
///
///   'R' · first run i64 · count u32 · sum of the draws u64, then for each row
///   status u8 · peaks_final i8 (−1: no such column) · outputs f64… · size u32, latch_order · size u32, reason
///
/// Draws are not stored: they are a pure function of plan and run, and are computed again on reading. Their checksum
/// shows whether the rows belong to this plan, and were made where draws have the same bits.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// First byte of a record of rows.
inline constexpr char rows_mark = 'R';

/// Delivers consecutive rows as records of some 64 KiB: a record ends with the row that reaches this size. So a reader
/// needs little memory.
void for_each_record(std::span<const ResultRow> rows,
                     const std::function<void(std::string_view)>& take);

/// The rows of a record, with their draws.
/// @param next runs of the analysis not read yet; the record must begin with the first of them
/// @param file for the message
/// @throws SpecError if the record begins with another run or is damaged, or the draws differ
[[nodiscard]] std::vector<ResultRow> rows_of_record(std::string_view record, const RunPlan& plan,
                                                    RunRange next, const std::string& file);

} // namespace wingspread
