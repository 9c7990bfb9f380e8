#include "studies/support/study.hpp"

#include "montecarlo/foundation/formats/csv.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cassert>

namespace wingspread::study {

int run_study(int count, char** arguments, const std::string& name, const std::string& purpose,
              const std::function<void(const StudyOptions&)>& study, const char* files) {
  StudyOptions options;
  std::string out;
  CLI::App app(purpose);
  app.add_flag("--quick", options.quick, "A few points in a few seconds");
  app.add_option("--out", out, "Folder; results/" + name + " by default, with --quick …_quick");
  if (files) app.add_option("files", options.files, files)->check(CLI::ExistingFile);
  CLI11_PARSE(app, count, arguments);
  options.folder = out.empty() ? "results/" + name + (options.quick ? "_quick" : "") : out;
  try {
    make_folder(options.folder);
    study(options);
    fmt::print("\n{}\n", options.folder.string());
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  }
}

Table::Table(std::initializer_list<std::string> columns) : columns_(columns.size()) {
  bool first = true;
  for (const std::string& column : columns) append(column, std::exchange(first, false));
  text_ += '\n';
}

void Table::add(std::initializer_list<Cell> cells) {
  assert(cells.size() == columns_);
  bool first = true;
  for (const Cell& cell : cells) append(cell, std::exchange(first, false));
  text_ += '\n';
}

void Table::append(const Cell& cell, bool first) {
  if (!first) text_ += ',';
  std::visit([this](const auto& value) { append_csv_cell(text_, value); }, cell);
}

void Table::write(const std::filesystem::path& file) const { write_file(file, text_); }

Scene seed_wing() { return read_scene_file("studies/scenes/three_panel.json"); }

Scene seed_wing(double stiffness, double damping) {
  Scene scene = seed_wing();
  for (Hinge& hinge : scene.hinges) hinge.latch = Latch{stiffness, damping};
  return scene;
}

Scene stack(int n) {
  Scene scene;
  scene.name = "stack";
  for (int i = 0; i < n; ++i) {
    const double side = i % 2 == 0 ? 1 : -1;
    Body body;
    body.name = fmt::format("panel_{}", i + 1);
    body.mass = 10, body.inertia = 0.5;
    scene.bodies.push_back(body);
    Hinge hinge;
    hinge.name = fmt::format("hinge_{}", i + 1);
    hinge.parent = i - 1, hinge.child = i;
    hinge.parent_point = i == 0 ? Eigen::Vector2d(0, 0) : Eigen::Vector2d(0.505, 0.02 * side);
    hinge.child_point = {-0.505, 0.02 * side};
    hinge.stowed = i == 0 ? 1.5707963267948966 : 3.141592653589793 * side;
    hinge.spring = {2, 1.4};
    scene.hinges.push_back(hinge);
  }
  return scene;
}

} // namespace wingspread::study
