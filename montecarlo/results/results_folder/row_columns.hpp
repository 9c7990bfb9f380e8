/// The columns of a file to which rows are appended.
#pragma once

#include "montecarlo/engine/runs/results.hpp"

#include <filesystem>

namespace wingspread {

/// Refuses to append rows below another header. Readers accept columns in any order; rows are written in one order.
/// @throws SpecError if the file has other columns than append_header() (results.hpp) writes, or in another order
void refuse_other_columns(const std::filesystem::path& file, const ResultNames& names);

} // namespace wingspread
