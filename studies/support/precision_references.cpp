#include "studies/support/precision_references.hpp"

#include "montecarlo/foundation/formats/csv.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "tests/support/reference_run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <numeric>

namespace wingspread::study {
namespace {

constexpr std::array<const char*, 4> source_names{"extended", "quad", "cvode", "regularized"};
constexpr int figures_of_hinge = 4;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Columns before those of the hinges.
enum Column { key, scene, latch, source, rtol, atol, t_end, seconds, first_figure };
constexpr const char* first_columns = "key,scene,latch,source,rtol,atol,t_end,seconds";

/// "event", or the ε of the smoothed latch.
std::string latch_name(const std::optional<double>& smoothing) {
  return smoothing ? fmt::format("{:g}", *smoothing) : "event";
}

/// A hash of the scene's parameters and the settings. It does not change when the oracle's code does.
std::string key_of(const Scene& scene, const ReferenceSettings& how) {
  return campaign_hash({{"scene", write_scene(scene)},
                        {"latch", latch_name(how.smoothing)},
                        {"source", to_string(how.source)},
                        {"rtol", how.rtol},
                        {"atol", how.atol},
                        {"t_end", how.t_end}});
}

/// The scene with its exact friction smoothed over a width, rad/s.
Scene regularized(Scene scene, double width) {
  for (Hinge& hinge : scene.hinges) {
    if (hinge.friction.model != FrictionModel::exact) continue;
    hinge.friction.model = FrictionModel::regularized;
    hinge.friction.regularization_rate = width;
    hinge.friction.static_level.reset();
  }
  return scene;
}

Figures run(const Scene& scene, const ReferenceSettings& how) {
  oracle::ReferenceOptions options;
  options.rtol = how.rtol, options.atol = how.atol;
  options.t_end = how.t_end, options.smoothing = how.smoothing;
  const auto run_of = [&] {
    switch (how.source) {
    case Source::extended:
      return oracle::high_precision_run<long double>(scene, options);
    case Source::quad:
      return oracle::high_precision_run<oracle::Quad>(scene, options);
    case Source::regularized:
      options.stiff = true;
      return oracle::cvode_run(regularized(scene, 1e-6), options);
    case Source::cvode:
      break;
    }
    return oracle::cvode_run(scene, options);
  };
  return figures_of(run_of(), scene.hinges.size());
}

/// Hinges by latch time.
std::vector<int> order_of(const std::vector<double>& times) {
  std::vector<int> order;
  for (int i = 0; i < std::ssize(times); ++i)
    if (!std::isnan(times[i])) order.push_back(i);
  std::ranges::stable_sort(order, {}, [&](int i) { return times[i]; });
  return order;
}

ReferenceRow parse(const std::vector<std::string>& cells, std::size_t hinges) {
  const auto number = [&](std::size_t k) { return parse_csv_number(cells[k]).value_or(none); };
  ReferenceRow row;
  row.key = cells[key];
  row.scene = static_cast<int>(number(scene));
  if (cells[latch] != "event") row.settings.smoothing = number(latch);
  const auto name = std::ranges::find(source_names, cells[source]);
  row.settings.source = static_cast<Source>(name - source_names.begin());
  row.settings.rtol = number(rtol), row.settings.atol = number(atol);
  row.settings.t_end = number(t_end), row.seconds = number(seconds);
  for (std::size_t i = 0; i < hinges; ++i) {
    const std::size_t first = first_figure + figures_of_hinge * i;
    row.figures.time.push_back(number(first));
    row.figures.rate.push_back(number(first + 1));
    row.figures.moment.push_back(number(first + 2));
    row.figures.force.push_back(number(first + 3));
  }
  row.figures.order = order_of(row.figures.time);
  return row;
}

void append_cell(std::string& text, double value) {
  text += ',';
  append_csv_cell(text, value);
}

} // namespace

const char* to_string(Source source) { return source_names[static_cast<int>(source)]; }

Disagreement disagreement(const Figures& a, const Figures& b) {
  if (a.order != b.order) return {};
  FigureErrors errors;
  errors.add(a, b);
  return {true, errors.time.largest, errors.rate.largest, errors.moment.largest,
          errors.force.largest};
}

ReferenceStore::ReferenceStore(std::filesystem::path file, std::vector<std::string> hinges)
    : file_(std::move(file)), hinges_(std::move(hinges)) {
  read();
}

std::string ReferenceStore::header() const {
  std::string text = first_columns;
  for (const std::string& hinge : hinges_)
    for (const char* figure : {"latch_time", "latch_rate", "peak_moment", "peak_force"})
      append_csv_cell(text += ',', fmt::format("{}.{}", hinge, figure));
  return text + ",order,off_time,off_rate,off_moment,off_force\n";
}

void ReferenceStore::read() {
  std::ifstream in(file_, std::ios::binary);
  std::string first;
  if (!std::getline(in, first) || first + '\n' != header()) return;
  CsvReader reader(in, file_.string());
  while (reader.next()) cached_.push_back(parse(reader.cells(), hinges_.size()));
}

ReferenceRow ReferenceStore::get(const Scene& scene, int number,
                                 const ReferenceSettings& settings) {
  const std::string wanted = key_of(scene, settings);
  const auto found = std::ranges::find(cached_, wanted, &ReferenceRow::key);
  if (found != cached_.end()) {
    rows_.push_back(*found);
    rows_.back().scene = number, rows_.back().settings = settings;
    cached_.erase(found);
    return rows_.back();
  }
  const auto start = std::chrono::steady_clock::now();
  Figures figures = run(scene, settings);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  rows_.push_back({wanted, number, settings, taken.count(), std::move(figures)});
  write();
  return rows_.back();
}

const ReferenceRow* ReferenceStore::primary_of(const ReferenceRow& row) const {
  const auto same = [&](const ReferenceRow& other) {
    return other.scene == row.scene && other.settings.smoothing == row.settings.smoothing;
  };
  const auto found = std::ranges::find_if(rows_, same); // finds at least `row`
  return &*found == &row ? nullptr : &*found;
}

void ReferenceStore::append(std::string& text, const ReferenceRow& row,
                            const ReferenceRow* primary) const {
  const ReferenceSettings& how = row.settings;
  text += fmt::format("{},{},{},{}", row.key, row.scene, latch_name(how.smoothing),
                      to_string(how.source));
  for (const double value : {how.rtol, how.atol, how.t_end, row.seconds}) append_cell(text, value);
  std::string order;
  for (const int hinge : row.figures.order) order += (order.empty() ? "" : ">") + hinges_[hinge];
  for (std::size_t i = 0; i < hinges_.size(); ++i)
    for (const auto* figure :
         {&row.figures.time, &row.figures.rate, &row.figures.moment, &row.figures.force})
      append_cell(text, (*figure)[i]);
  append_csv_cell(text += ',', order);
  const Disagreement off = primary ? disagreement(row.figures, primary->figures) : Disagreement{};
  for (const double value : {off.time, off.rate, off.moment, off.force})
    append_cell(text, off.same_order ? value : none);
  text += '\n';
}

void ReferenceStore::write() const {
  std::string text = header();
  for (const ReferenceRow& row : rows_) append(text, row, primary_of(row));
  for (const ReferenceRow& row : cached_) append(text, row, nullptr);
  make_folder(file_.parent_path());
  write_file(file_, text);
}

} // namespace wingspread::study
