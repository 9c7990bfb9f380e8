#include "montecarlo/engine/accuracy/run_check.hpp"

#include "montecarlo/engine/accuracy/accuracy.hpp"
#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/model/campaign/outputs.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace wingspread {
namespace {

constexpr int most_digits = 16; // a double has 15.95

/// @param least differences up to this do not count
CheckedOutput compare(const std::string& name, double value, double reference, double least) {
  CheckedOutput output{name, value, reference};
  if (std::isnan(value) && std::isnan(reference)) return output;
  output.moved = std::isnan(value) != std::isnan(reference) || moved(value, reference, least);
  const bool both_zero = std::max(std::abs(value), std::abs(reference)) <= least;
  output.digits = both_zero ? most_digits : agreeing_digits(value, reference);
  return output;
}

} // namespace

int agreeing_digits(double a, double b) {
  if (a == b) return most_digits;
  const double relative = std::abs(a - b) / std::max(std::abs(a), std::abs(b));
  if (!(relative < 1)) return 0;
  return std::min(most_digits, static_cast<int>(std::floor(-std::log10(relative))));
}

std::optional<RunCheck> check_run(const Scene& scene, const Integration& integration,
                                  const Goal& goal, const Outcome& own) {
  for (Integration reference : references_of(integration)) {
    reference.max_steps = steps_of_reference(own.work.steps);
    const Outcome again = Deployment().run(scene, reference, goal, Observer{});
    if (again.status == Status::failed) continue;
    RunCheck check{reference.method,          reference.rtol, to_string(again.status),
                   latch_order(scene, again), false,          {}};
    check.agrees = again.status == own.status && check.latch_order == latch_order(scene, own);
    Outputs integrated = all_outputs();
    integrated.erase(OutputFamily::frequency);
    const std::vector<OutputColumn> columns = output_columns(scene, integrated);
    std::map<std::string, double> largest; // of the outputs in a unit
    for (const OutputColumn& column : columns) {
      double& most = largest[parse_output_name(column.name).unit];
      most = std::fmax(most, std::abs(output_of(column, again)));
    }
    for (const OutputColumn& column : columns) {
      const double least =
          std::max(unresolved(column.name, integration),
                   integration.rtol * largest[parse_output_name(column.name).unit]);
      check.outputs.push_back(
          compare(column.name, output_of(column, own), output_of(column, again), least));
    }
    return check;
  }
  return std::nullopt;
}

} // namespace wingspread
