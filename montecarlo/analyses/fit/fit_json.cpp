#include "montecarlo/analyses/fit/fit_report.hpp"
#include "montecarlo/foundation/formats/csv.hpp"

#include <fmt/format.h>

namespace wingspread {
namespace {

Json parameters_json(const FitResult& result) {
  Json json = Json::object();
  for (const FittedParameter& each : result.parameters) {
    json[each.name] = {{"prior",
                        {{"mean", each.prior_mean},
                         {"std", each.prior_std},
                         {"lower", each.prior_lower},
                         {"upper", each.prior_upper}}},
                       {"mode", each.mode},
                       {"mean", each.mean},
                       {"std", each.std},
                       {"lower", each.lower},
                       {"upper", each.upper},
                       {"std_ratio", each.std_ratio()}};
    if (!each.unit.empty()) json[each.name]["unit"] = each.unit;
    if (!result.held.empty()) json[each.name]["std_with_held"] = each.widening * each.std;
    if (each.held_decides) json[each.name]["held_decides"] = true;
    if (each.limit) json[each.name]["at_limit"] = *each.limit;
  }
  return json;
}

/// The parameters that lie at a limit of their priors.
Json limited_json(const FitResult& result) {
  Json json = Json::array();
  for (const FittedParameter& each : result.parameters)
    if (each.limit) json.push_back(each.name);
  return json;
}

Json held_json(const FitResult& result) {
  Json json = Json::object();
  for (const HeldDispersion& each : result.held) {
    json[each.name] = {{"value", each.median},
                       {"prior", {{"mean", each.prior_mean}, {"std", each.prior_std}}}};
    for (const auto& [test, median] : each.in_tests) json[each.name]["in_tests"][test] = median;
  }
  return json;
}

Json correlation_json(const FitResult& result) {
  Json json = Json::object();
  for (std::size_t i = 0; i < result.parameters.size(); ++i)
    for (std::size_t j = 0; j < result.parameters.size(); ++j)
      json[result.parameters[i].name][result.parameters[j].name] = json_number(
          result.correlation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
  return json;
}

std::vector<std::string> common_names(const FitResult& result) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < result.common; ++k) names.push_back(result.parameters[k].name);
  return names;
}

Json unseen_json(const FitResult& result) {
  const std::vector<std::string> names = common_names(result);
  Json list = Json::array();
  for (const FitDirection& direction : result.directions) {
    if (direction.std_ratio < unseen_ratio) continue;
    Json weights = Json::object();
    for (Eigen::Index i = 0; i < direction.weights.size(); ++i)
      if (std::abs(direction.weights[i]) >= named_weight)
        weights[names[static_cast<std::size_t>(i)]] = direction.weights[i];
    list.push_back(
        {{"direction", std::move(weights)},
         {"std_ratio", direction.std_ratio},
         {"text", describe(direction, names, result.score_covariance, result.prior_covariance)}});
  }
  return list;
}

Json trace_json(const FittedChannel& fitted) {
  const bool known = fitted.channel.std.has_value();
  Json json{{"rms", fitted.rms},
            {"chi_squared", json_number(fitted.chi_squared)},
            {"n", fitted.channel.count},
            {"n_effective", fitted.channel.effective},
            {"p_value", json_number(fitted.p_value)}};
  if (!known) json["estimated_std"] = fitted.rms;
  for (const Outlier& each : fitted.outliers)
    json["outliers"].push_back(
        {{"t", each.time}, {"measured", each.measured}, {"sigmas", each.sigmas}});
  if (fitted.channel.offset_std > 0 && known) json["offset"] = fitted.offset;
  return json;
}

Json tests_json(const FitResult& result, const FitSpec& spec) {
  Json list = Json::array();
  for (const FitTest& test : spec.tests)
    list.push_back({{"name", test.name}, {"traces", Json::object()}, {"values", Json::object()}});
  for (const FittedChannel& fitted : result.channels) {
    Json& test = list[fitted.channel.test];
    if (fitted.channel.column)
      test["traces"][fitted.name] = trace_json(fitted);
    else
      test["values"][fitted.name] = {
          {"unit", spec.tests[fitted.channel.test].values[fitted.channel.value].unit},
          {"measured", fitted.measured},
          {"fitted", json_number(fitted.fitted)},
          {"sigmas", json_number(fitted.sigmas)},
          {"p_value", json_number(fitted.p_value)}};
  }
  return list;
}

Json candidates_json(const FitResult& result) {
  Json list = Json::array();
  for (const CandidateGain& gain : result.candidates) {
    Json shrink = Json::object();
    for (std::size_t k = 0; k < result.parameters.size(); ++k)
      shrink[result.parameters[k].name] = gain.shrink[k];
    list.push_back({{"name", gain.name}, {"information", gain.information}, {"std_ratio", shrink}});
  }
  return list;
}

Json quantiles_json(const std::array<double, 3>& values) {
  return {json_number(values[0]), json_number(values[1]), json_number(values[2])};
}

} // namespace

Json fit_json(const FitResult& result, const FitSpec& spec, const Json& about) {
  Json modes = Json::array();
  for (const OtherMode& mode : result.other_modes) {
    Json parameters = Json::object();
    for (std::size_t i = 0; i < mode.parameters.size(); ++i)
      parameters[result.parameters[i].name] = mode.parameters[i];
    modes.push_back({{"distance", mode.distance},
                     {"log_posterior_below_best", mode.drop},
                     {"parameters", std::move(parameters)}});
  }
  Json prediction = Json::object();
  for (const PredictedOutput& output : result.prediction.outputs)
    prediction[output.name] = {{"before", quantiles_json(output.before)},
                               {"after", quantiles_json(output.after)},
                               {"cut", output.cut}};
  Json json = about;
  json.update({{"scene", spec.tests.front().campaign.scene.name},
               {"confidence", fit_confidence},
               {"finished", result.finished},
               {"findings", fit_findings(result, spec)},
               {"parameters", parameters_json(result)},
               {"at_limits", limited_json(result)},
               {"held", held_json(result)},
               {"correlation", correlation_json(result)},
               {"sampler",
                {{"ess", result.sampler.ess},
                 {"r_hat", json_number(result.sampler.r_hat)},
                 {"acceptance", result.sampler.acceptance},
                 {"runs", result.sampler.evaluations}}},
               {"unseen", unseen_json(result)},
               {"prior_decides", names_by_prior(result)},
               {"other_modes", std::move(modes)},
               {"tests", tests_json(result, spec)}});
  const ReportHeader& words = spec.tests.front().campaign.report;
  if (words != ReportHeader{}) json["report"] = write_report_header(words);
  if (result.values.count > 0)
    json["values"] = {{"n", result.values.count},
                      {"chi_squared", json_number(result.values.chi_squared)},
                      {"p_value", json_number(result.values.p_value)}};
  if (!result.candidates.empty()) json["candidates"] = candidates_json(result);
  if (!prediction.empty()) {
    json["prediction"] = std::move(prediction);
    json["predicted_deployed"] = {{"before", result.prediction.deployed[0]},
                                  {"after", result.prediction.deployed[1]}};
  }
  return json;
}

std::string posterior_csv(const FitResult& result) {
  std::string text;
  const auto end_line = [&] {
    text.back() = '\n'; // in place of the last comma
  };
  for (const std::string& name : result.posterior.names) {
    append_csv_cell(text, name);
    text += ',';
  }
  if (text.empty()) return text;
  end_line();
  for (const std::vector<double>& row : result.posterior.rows) {
    for (const double value : row) {
      append_csv_cell(text, value);
      text += ',';
    }
    end_line();
  }
  return text;
}

std::string traces_csv(const FitResult& result, const FitSpec& spec) {
  std::string text = "test,column,t,measured,fitted,lower,upper\n";
  for (const FittedChannel& fitted : result.channels) {
    if (!fitted.channel.column) continue;
    const FitTest& test = spec.tests[fitted.channel.test];
    const std::vector<double>& measured = test.columns[*fitted.channel.column].measured;
    for (std::size_t i = 0; i < test.times.size(); ++i) {
      append_csv_cell(text, test.name);
      append_csv_cells(text, fitted.name, test.times[i], measured[i],
                       fitted.mode[i] + fitted.offset, fitted.lower[i] + fitted.offset,
                       fitted.upper[i] + fitted.offset);
      text += '\n';
    }
  }
  return text;
}

} // namespace wingspread
