/// Rows of results as records of bytes, to the bit.
///
///   'R' · first run i64 · count u32 · sum of the draws u64, then for each row
///   status u8 · peaks_final i8 (−1: no such column) · outputs f64… · size u32, latch_order · size u32, reason
///
/// The draws are not kept: they are a pure function of the plan and the run, and made again where the rows are read.
/// Their sum says whether they come out the same: so whether the rows are those of this plan on this kind of machine.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// What a record of rows begins with.
inline constexpr char rows_mark = 'R';

/// Hands on consecutive rows as records of some 64 KiB at most, so that whoever reads them needs no more memory than
/// that; longer only where a single row is.
void for_each_record(std::span<const ResultRow> rows,
                     const std::function<void(std::string_view)>& take);

/// The rows of a record, with their draws.
/// @param next the runs that are left of the look: the rows are its first ones
/// @param file that it is from, for the message
/// @throws SpecError when they are not, or are no rows of the plan
[[nodiscard]] std::vector<ResultRow> rows_of_record(std::string_view record, const RunPlan& plan,
                                                    RunRange next, const std::string& file);

} // namespace wingspread
