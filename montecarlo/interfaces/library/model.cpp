#include "core/deployment.hpp"
#include "montecarlo/foundation/formats/nearest.hpp"
#include "montecarlo/foundation/platform/arithmetic.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/interfaces/library/single_run.hpp"
#include "montecarlo/model/campaign/outputs.hpp"
#include "montecarlo/model/scene_file/scene_parameter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <iterator>
#include <limits>
#include <utility>

namespace wingspread::api {
namespace {

std::vector<std::string> names_of(const std::vector<OutputColumn>& columns) {
  std::vector<std::string> names;
  std::ranges::transform(columns, std::back_inserter(names), &OutputColumn::name);
  return names;
}

/// Finds the parameters of each path; appends what is wrong to `problems`.
std::vector<std::vector<SceneParameter>> find_parameters(const std::vector<std::string>& paths,
                                                         const Scene& scene,
                                                         std::vector<Problem>& problems) {
  std::vector<std::vector<SceneParameter>> parameters(paths.size());
  std::vector<SceneParameter> seen;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const Json path = paths[i];
    std::vector<Problem> its;
    const JsonCursor at(path, "", its);
    for (const ParameterMatch& match : read_path(at, &scene)) {
      if (std::ranges::find(seen, match.parameter) != seen.end())
        at.refuse_repeated(path_of(scene, match.parameter), "each parameter once");
      seen.push_back(match.parameter);
      parameters[i].push_back(match.parameter);
    }
    for (const Problem& problem : its)
      problems.push_back({"", fmt::format("paths[{}]", i), problem.found, problem.expected});
  }
  return parameters;
}

std::vector<OutputColumn> find_outputs(const std::vector<std::string>& wanted, const Scene& scene,
                                       std::vector<Problem>& problems) {
  const std::vector<OutputColumn> all = output_columns(scene, all_outputs());
  std::vector<OutputColumn> columns;
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (const auto found = std::ranges::find(all, wanted[i], &OutputColumn::name);
        found != all.end())
      columns.push_back(*found);
    else
      problems.push_back({"", fmt::format("outputs[{}]", i), fmt::format("\"{}\"", wanted[i]),
                          "an output of the scene" + did_you_mean(wanted[i], names_of(all))});
  return columns;
}

/// The output families that these columns need. Runs do not compute other families.
Outputs families_of(const std::vector<OutputColumn>& columns) {
  Outputs families;
  for (const OutputColumn& column : columns)
    if (const auto family = family_of(column.quantity)) families.insert(*family);
  return families;
}

/// @param d, m the numbers of components of x and of y @throws SpecError
void check_sizes(std::size_t x, std::size_t y, std::size_t d, std::size_t m) {
  if (x % d != 0)
    throw SpecError({{"", "x", fmt::format("{} numbers", x),
                      fmt::format("rows of {} numbers, one for each parameter", d)}});
  if (y != x / d * m)
    throw SpecError({{"", "y", fmt::format("{} numbers", y),
                      fmt::format("{} rows of {} numbers, one for each output", x / d, m)}});
}

} // namespace

struct Model::Prepared {
  Task task;
  std::vector<std::vector<SceneParameter>> parameters; ///< by column of x
  std::vector<OutputColumn> columns;                   ///< of y
  std::vector<std::string> outputs, notices;
  std::vector<double> nominal;
  Goal goal;

  void set_parameters(std::span<const double> x, Scene& scene) const {
    for (std::size_t j = 0; j < parameters.size(); ++j)
      for (const SceneParameter& parameter : parameters[j]) parameter.in(scene) = x[j];
  }
  void write_outputs(const wingspread::Outcome& outcome, std::span<double> y) const {
    for (std::size_t j = 0; j < columns.size(); ++j) y[j] = output_of(columns[j], outcome);
  }
};

Model::Model(const Input& input, const std::vector<std::string>& paths,
             std::vector<std::string> outputs, const Settings& settings) {
  const DefaultArithmetic arithmetic;
  auto prepared = std::make_shared<Prepared>();
  prepared->task = task_of(read_input(input), settings);
  const Scene& scene = prepared->task.scene;
  if (outputs.empty()) outputs = names_of(output_columns(scene, default_outputs(scene)));
  std::vector<Problem> problems;
  prepared->parameters = find_parameters(paths, scene, problems);
  prepared->columns = find_outputs(outputs, scene, problems);
  if (paths.empty()) problems.push_back({"", "paths", "none", "at least one parameter's path"});
  if (!problems.empty()) throw SpecError(std::move(problems));
  prepared->outputs = std::move(outputs);
  prepared->goal = goal_of(families_of(prepared->columns));
  for (const auto& parameters : prepared->parameters) {
    const double first = parameters.front().in(scene);
    const auto is_first = [&](const SceneParameter& each) { return each.in(scene) == first; };
    prepared->nominal.push_back(std::ranges::all_of(parameters, is_first)
                                    ? first
                                    : std::numeric_limits<double>::quiet_NaN());
  }
  prepared->notices = notices_of(prepared->task, input.file);
  prepared_ = std::move(prepared);
}

const std::vector<std::string>& Model::notices() const { return prepared_->notices; }

std::size_t Model::parameters() const { return prepared_->parameters.size(); }

const std::vector<std::string>& Model::outputs() const { return prepared_->outputs; }

const std::vector<double>& Model::nominal() const { return prepared_->nominal; }

bool Model::evaluate(std::span<const double> x, std::span<double> y, int threads,
                     const std::atomic<bool>* stop) const {
  const DefaultArithmetic arithmetic;
  const Prepared& model = *prepared_;
  const std::size_t d = parameters(), m = outputs().size();
  const auto rows = static_cast<long>(x.size() / d);
  check_sizes(x.size(), y.size(), d, m);
  check_threads(threads);
  if (rows == 0) return true;
  std::atomic<long> begun = 0, ended = 0;
  std::atomic<bool> broken = false;
  const auto next = [&](Scene& scene) -> std::optional<long> {
    if (broken || (stop && *stop)) return std::nullopt;
    const long row = begun++;
    if (row >= rows) return std::nullopt;
    model.set_parameters(x.subspan(static_cast<std::size_t>(row) * d, d), scene);
    return row;
  };
  const auto done = [&](long row, wingspread::Outcome&& outcome) {
    model.write_outputs(outcome, y.subspan(static_cast<std::size_t>(row) * m, m));
    ++ended;
  };
  const auto work = [&] {
    DeploymentPack(instruction_sets().back(), model.task.integration, model.goal)
        .run(model.task.scene, next, done);
  };
  run_on_threads(static_cast<int>(std::min<long>(thread_count(threads), rows)), work,
                 [&] { broken = true; });
  return ended == rows;
}

} // namespace wingspread::api
