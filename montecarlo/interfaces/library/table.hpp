/// The data of a library table.
#pragma once

#include "montecarlo/interfaces/library/wingspread.hpp"
#include "montecarlo/results/results_folder/results_folder.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace wingspread::api {

/// A column of repeated texts: row i has texts[codes[i]].
struct WordColumn {
  std::vector<std::string> texts;
  std::vector<std::uint32_t> codes;
};

struct Table::Data {
  ResultNames names;
  Results results;
  WordColumn status, peaks_final;
  std::vector<std::string> latch_orders; ///< the texts of results.latch_order
  std::string campaign;                  ///< the text of campaign.json
  std::vector<std::string> warnings;
  bool complete = false;
};

/// Makes a table of results. @param stored the campaign of these runs
[[nodiscard]] Table table_of(const StoredCampaign& stored, const ResultNames& names,
                             Results&& results, std::vector<std::string> warnings);

} // namespace wingspread::api
