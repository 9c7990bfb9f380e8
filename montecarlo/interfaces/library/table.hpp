/// What is behind the library's tables.
#pragma once

#include "montecarlo/interfaces/library/wingspread.hpp"
#include "montecarlo/results/results_folder/results_folder.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace wingspread::api {

/// Texts and codes of a column, in memory.
struct WordColumn {
  std::vector<std::string> texts;
  std::vector<std::uint32_t> codes;
};

struct Table::Data {
  ResultNames names;
  Results results;
  WordColumn status, peaks_final;
  std::vector<std::string> latch_orders; ///< the texts of results.latch_order
  std::string campaign;                  ///< as campaign.json has it
  std::vector<std::string> notices;
  bool complete = false;
};

/// @param stored of whose runs these are
[[nodiscard]] Table table_of(const StoredCampaign& stored, const ResultNames& names,
                             Results&& results, std::vector<std::string> notices);

} // namespace wingspread::api
