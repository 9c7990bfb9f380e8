#include "montecarlo/interfaces/library/table.hpp"

#include "montecarlo/foundation/formats/nearest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace wingspread::api {
namespace {

constexpr std::string_view status_column = "status", latch_order_column = "latch_order";

template <class Enum, class Texts>
WordColumn words_of(const Spilled<Enum>& values, const Texts& all) {
  WordColumn words;
  for (const Enum value : all) words.texts.emplace_back(to_string(value));
  words.codes.reserve(values.size());
  for (const Enum value : values) words.codes.push_back(static_cast<std::uint32_t>(value));
  values.release();
  return words;
}

std::vector<std::string> texts_of(const DictionaryColumn& column) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < column.texts().size(); ++i) texts.emplace_back(column.texts()[i]);
  return texts;
}

SpecError no_column(std::string_view column, std::string_view kind,
                    const std::vector<std::string>& known) {
  return SpecError({{"", "", fmt::format("\"{}\"", column),
                     fmt::format("a column of {}{}", kind, did_you_mean(column, known))}});
}

} // namespace

Table table_of(const StoredCampaign& stored, const ResultNames& names, Results&& results,
               std::vector<std::string> warnings) {
  auto data = std::make_shared<Table::Data>();
  data->complete = is_complete(stored, results);
  data->names = names;
  data->status = words_of(results.status, statuses);
  data->peaks_final = words_of(results.peaks_final, all_peaks_final);
  data->latch_orders = texts_of(results.latch_order);
  data->campaign = campaign_text(stored.campaign, stored.stamp);
  data->warnings = std::move(warnings);
  data->results = std::move(results);
  return Table(std::move(data));
}

std::size_t Table::size() const { return data_->results.size(); }

std::vector<std::string> Table::columns() const { return header_cells(data_->names); }

std::vector<std::string> Table::draws() const { return data_->names.draws; }

std::vector<std::string> Table::outputs() const { return data_->names.outputs; }

std::span<const long> Table::runs() const { return data_->results.runs; }

std::span<const double> Table::numbers(std::string_view column) const {
  for (const std::vector<Column>* columns : {&data_->results.draws, &data_->results.outputs})
    if (const auto found = std::ranges::find(*columns, column, &Column::name);
        found != columns->end())
      return found->values;
  std::vector<std::string> known = draws();
  known.insert(known.end(), data_->names.outputs.begin(), data_->names.outputs.end());
  throw no_column(column, "numbers", known);
}

Words Table::words(std::string_view column) const {
  if (column == status_column) return {data_->status.texts, data_->status.codes};
  if (column == latch_order_column)
    return {data_->latch_orders, data_->results.latch_order.codes()};
  if (column == peaks_final_column && data_->results.has_peaks_final)
    return {data_->peaks_final.texts, data_->peaks_final.codes};
  std::vector<std::string> known{std::string(status_column), std::string(latch_order_column)};
  if (data_->results.has_peaks_final) known.emplace_back(peaks_final_column);
  throw no_column(column, "words", known);
}

std::string Table::reason(std::size_t row) const { return std::string(data_->results.reason[row]); }

bool Table::is_complete() const { return data_->complete; }

const std::string& Table::campaign() const { return data_->campaign; }

const std::vector<std::string>& Table::notices() const { return data_->warnings; }

} // namespace wingspread::api
