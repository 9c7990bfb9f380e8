#include "montecarlo/report/page/fit_set.hpp"

#include "montecarlo/analyses/fit/fit_campaign.hpp"
#include "montecarlo/analyses/fit/fit_report.hpp"
#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/engine/runs/trajectory_columns.hpp"
#include "montecarlo/foundation/formats/csv.hpp"
#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/model/scene_file/scene_parameter.hpp"
#include "montecarlo/report/data/page_numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <span>

namespace wingspread {
namespace {

constexpr std::size_t most_times = 400; // of a trace: a picture has some 600 pixels
constexpr std::size_t most_rows = 400;  // of the posterior: more points hide each other

/// All rows of a CSV file without its header.
std::vector<std::vector<std::string>> rows_of(const std::filesystem::path& path,
                                              std::vector<std::string>& header) {
  std::ifstream in(path);
  CsvReader reader(in, path.string());
  std::vector<std::vector<std::string>> rows;
  if (reader.next()) header = reader.cells();
  while (reader.next()) {
    rows.push_back(reader.cells());
    if (rows.back().size() != header.size())
      throw reader.error("", "another number of cells", "as many as in the header");
  }
  return rows;
}

Json number_of(const std::string& cell) {
  const auto value = parse_csv_number(cell);
  return value ? page_number(*value) : Json(nullptr);
}

/// The first of `most` parts of `count` rows, as equal as can be; of fewer rows each is a part.
std::vector<std::size_t> parts_of(std::size_t count, std::size_t most) {
  std::vector<std::size_t> starts;
  const std::size_t kept = std::min(count, most);
  for (std::size_t k = 0; k < kept; ++k) starts.push_back(k * count / kept);
  return starts;
}

using CsvRows =
    std::span<const std::vector<std::string>>; // of a trace: test, column, t, measured, fitted, …

/// |measured − fitted|; 0 without a measured number.
double residual_of(const std::vector<std::string>& row) {
  const double size = std::abs(parse_csv_number(row.at(3)).value_or(undefined) -
                               parse_csv_number(row.at(4)).value_or(undefined));
  return std::isnan(size) ? 0 : size;
}

/// The rows of a trace that are drawn, ascending: of each part the first and the one furthest from the fit, and the
/// 400 furthest outliers of fit.json, so that each sample that a finding names is drawn.
std::vector<std::size_t> drawn_rows(CsvRows rows, const Json& outliers) {
  if (rows.size() <= most_times) return parts_of(rows.size(), most_times);
  std::vector<std::size_t> drawn = parts_of(rows.size(), most_times / 2);
  const std::vector<std::size_t> starts = drawn;
  for (std::size_t k = 0; k < starts.size(); ++k) {
    const CsvRows part =
        rows.subspan(starts[k], (k + 1 < starts.size() ? starts[k + 1] : rows.size()) - starts[k]);
    const auto worst = std::ranges::max_element(part, {}, residual_of);
    drawn.push_back(starts[k] + static_cast<std::size_t>(worst - part.begin()));
  }
  for (std::size_t k = 0; k < std::min(outliers.size(), most_times); ++k) // the furthest first
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (parse_csv_number(rows[i].at(2)) == outliers[k].at("t").get<double>()) drawn.push_back(i);
  std::ranges::sort(drawn);
  drawn.erase(std::ranges::unique(drawn).begin(), drawn.end());
  return drawn;
}

Json traces_json(const std::filesystem::path& folder, const Json& study) {
  constexpr std::array series{"t", "measured", "fitted", "lower", "upper"};
  std::vector<std::string> header;
  const auto rows = rows_of(folder / traces_csv_file, header);
  Json traces = Json::array();
  for (std::size_t first = 0; first < rows.size();) {
    std::size_t last = first;
    while (last < rows.size() && rows[last][0] == rows[first][0] && rows[last][1] == rows[first][1])
      ++last;
    Json trace{{"test", rows[first][0]},
               {"column", rows[first][1]},
               {"unit", unit_of_column(rows[first][1])}};
    for (const char* name : series) trace[name] = Json::array();
    for (const Json& test : study.at("tests"))
      if (test.at("name") == trace["test"]) trace.update(test.at("traces").at(rows[first][1]));
    const CsvRows own = CsvRows(rows).subspan(first, last - first);
    trace["samples"] = own.size();
    for (const std::size_t row : drawn_rows(own, trace.value("outliers", Json::array())))
      for (std::size_t i = 0; i < series.size(); ++i)
        trace[series[i]].push_back(number_of(own[row].at(i + 2)));
    traces.push_back(std::move(trace));
    first = last;
  }
  return traces;
}

Json samples_json(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  const auto rows = rows_of(folder / posterior_file, names);
  Json samples{{"names", names}, {"rows", Json::array()}, {"samples", rows.size()}};
  for (const std::size_t row : parts_of(rows.size(), most_rows)) {
    Json values = Json::array();
    for (const std::string& cell : rows[row]) values.push_back(number_of(cell));
    samples["rows"].push_back(std::move(values));
  }
  return samples;
}

/// The unit of a measured value: an output's, or a scene parameter's.
std::string_view unit_of_value(const std::string& name, const Scene* scene) {
  const std::string_view unit = parse_output_name(name).unit;
  if (!unit.empty() || !scene) return unit;
  const ParameterMatches found = resolve(*scene, name);
  return found.matches.empty() ? unit : unit_of(found.matches.front().parameter);
}

/// Adds each predicted output's unit.
Json prediction_json(Json prediction) {
  for (auto& [name, output] : prediction.items()) output["unit"] = parse_output_name(name).unit;
  return prediction;
}

} // namespace

Json fit_block(const std::filesystem::path& folder, const Scene* scene) {
  const Json study = parse_json_file(folder / fit_json_file);
  Json parameters = Json::array();
  for (const auto& [name, values] : study.at("parameters").items()) {
    Json parameter{{"name", name}};
    parameter.update(values);
    parameters.push_back(std::move(parameter));
  }
  Json values = Json::array();
  for (const Json& test : study.at("tests"))
    for (const auto& [name, value] : test.at("values").items()) {
      Json row{{"test", test.at("name")}, {"name", name}, {"unit", unit_of_value(name, scene)}};
      row.update(value); // with its unit; of older versions without
      values.push_back(std::move(row));
    }
  return {{"finished", study.at("finished")},
          {"findings", study.at("findings")},
          {"parameters", std::move(parameters)},
          {"unseen", study.at("unseen")},
          {"prior_decides", study.value("prior_decides", Json::array())},
          {"values", std::move(values)},
          {"traces", traces_json(folder, study)},
          {"samples",
           std::filesystem::exists(folder / posterior_file) ? samples_json(folder) : Json(nullptr)},
          {"candidates", study.value("candidates", Json::array())},
          {"deployed", study.value("predicted_deployed", Json(nullptr))},
          {"prediction", prediction_json(study.value("prediction", Json::object()))}};
}

} // namespace wingspread
