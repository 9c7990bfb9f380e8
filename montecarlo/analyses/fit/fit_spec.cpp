#include "montecarlo/analyses/fit/fit_spec.hpp"

#include "montecarlo/analyses/fit/fit_campaign.hpp"
#include "montecarlo/analyses/fit/trace_check.hpp"
#include "montecarlo/engine/runs/trajectory_columns.hpp"
#include "montecarlo/foundation/formats/csv.hpp"
#include "montecarlo/foundation/formats/nearest.hpp"
#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/foundation/formats/quantity.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace wingspread {
namespace {

constexpr std::int64_t most_starts = 1000, least_samples = 100, most_samples = 10'000'000;
constexpr double most_candidate_times = 1e5; // heuristic: beyond, it is a mistake

bool is_starts(const std::int64_t& n) { return 1 <= n && n <= most_starts; }
bool is_samples(const std::int64_t& n) { return least_samples <= n && n <= most_samples; }

void read_truth(JsonObject& object, std::string_view key, bool& out) {
  const auto at = object.find(key);
  if (at && !at->value().is_boolean())
    at->refuse("true or false");
  else if (at)
    out = at->value().get<bool>();
}

class FitReader {
public:
  FitReader(const Campaign& campaign, std::filesystem::path directory)
      : campaign_(campaign), directory_(std::move(directory)) {}

  void read(const JsonCursor& at, FitSpec& spec) {
    JsonObject object(at, "deployment tests: an object with tests and fit");
    if (const auto fit = object.require("fit", "an object with parameters"))
      read_settings(*fit, spec);
    fitted_ = spec.parameters;
    if (const auto tests = object.require("tests", "an array of at least one test"))
      read_tests(*tests, false, spec.tests);
    if (const auto candidates = object.find("candidates"))
      read_tests(*candidates, true, spec.candidates);
    object.refuse_others();
  }

private:
  /// The dispersions that a name or a pattern such as "friction.*" matches.
  std::vector<std::size_t> read_names(const JsonCursor& at) const {
    std::string pattern;
    std::vector<std::size_t> found;
    if (!at.read(pattern, "a string, the name of a dispersion; * stands for any characters"))
      return found;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < campaign_.dispersions.size(); ++i) {
      names.push_back(campaign_.dispersions[i].name);
      if (is_like(names.back(), pattern)) found.push_back(i);
    }
    if (found.empty())
      at.refuse(fmt::format("\"{}\"", pattern),
                "the name of a dispersion" + did_you_mean(pattern, names));
    return found;
  }

  void read_settings(const JsonCursor& at, FitSpec& spec) {
    JsonObject object(at, "an object with parameters");
    std::int64_t starts = spec.starts, samples = spec.samples;
    constexpr const char* expected = "an array of names of dispersions, at least one";
    if (const auto names = object.require("parameters", expected)) {
      if (!names->value().is_array() || names->value().empty()) names->refuse(expected);
      for (const JsonCursor& name : names->elements()) add_parameters(name, spec.parameters);
      std::ranges::sort(spec.parameters);
      refuse_half_correlated(*names, spec.parameters);
    }
    object.optional("starts", starts, fmt::format("an integer from 1 to {}", most_starts),
                    is_starts);
    object.optional("samples", samples,
                    fmt::format("an integer from {} to {}", least_samples, most_samples),
                    is_samples);
    read_truth(object, "correlated", correlated_);
    spec.starts = static_cast<int>(starts);
    spec.samples = static_cast<long>(samples);
    object.refuse_others();
  }

  void add_parameters(const JsonCursor& at, std::vector<std::size_t>& parameters) const {
    for (const std::size_t index : read_names(at)) {
      const Law& law = campaign_.dispersions[index].distribution.law;
      if (std::holds_alternative<Discrete>(law) || std::holds_alternative<Empirical>(law) ||
          std::holds_alternative<Constant>(law))
        at.refuse(quoted(index) + ", whose law has steps", "a dispersion with a continuous law");
      else if (is_unit(header_cell(campaign_.dispersions[index].name).unit))
        at.refuse(quoted(index) + ", which would head a column of posterior.csv in that unit",
                  "a name without a unit in brackets: the values are in SI units");
      else if (std::ranges::find(parameters, index) != parameters.end())
        at.refuse_repeated(quoted(index), "each parameter once");
      else
        parameters.push_back(index);
    }
  }

  /// A fitted parameter's correlation with one that is not fitted would be lost in the prediction.
  void refuse_half_correlated(const JsonCursor& at, const std::vector<std::size_t>& fitted) const {
    const auto is_fitted = [&](std::size_t i) {
      return std::ranges::find(fitted, i) != fitted.end();
    };
    for (const RankCorrelation& pair : campaign_.wanted_correlations)
      if (is_fitted(pair.first) != is_fitted(pair.second))
        at.refuse("one of " + quoted(pair.first) + " and " + quoted(pair.second) +
                      ", which the campaign correlates",
                  "both of them, or neither");
  }

  void read_tests(const JsonCursor& at, bool candidate, std::vector<FitTest>& tests) {
    if (!at.value().is_array() || at.value().empty()) at.refuse("an array of at least one test");
    std::set<std::string> names;
    for (const JsonCursor& element : at.elements()) {
      tests.push_back(read_test(element, candidate));
      if (const std::string& name = tests.back().name; !name.empty() && !names.insert(name).second)
        element.refuse_repeated(fmt::format("\"{}\"", name), "a name of its own");
    }
  }

  FitTest read_test(const JsonCursor& at, bool candidate) {
    FitTest test;
    JsonObject object(at, "a test: an object");
    object.required(
        "name", test.name, "a string, not empty",
        +[](const std::string& name) { return !name.empty(); });
    test.campaign = campaign_of_test(campaign_, read_case(object));
    change_scene_of(object, test);
    const auto trace = object.find("trace");
    if (trace) read_trace_of(*trace, candidate, test);
    const auto values = object.find("values");
    if (values) read_values(*values, candidate, test);
    if (object.is_object() && !trace && !values)
      at.refuse("neither a trace nor values", "at least one of them");
    if (const auto own = object.find("own")) {
      if (candidate)
        own->refuse("parameters of its own in a candidate", "common parameters only");
      else
        read_own(*own, test);
    }
    if (candidate && test.time_offset_std > 0) at.refuse("a time offset in a candidate", "none");
    refuse_other_laws(at, candidate, test);
    object.refuse_others();
    return test;
  }

  /// A fitted parameter to which the test's case gives another law has a value of its own there: the posterior of all
  /// tests would be stated by the wrong law.
  void refuse_other_laws(const JsonCursor& at, bool candidate, const FitTest& test) const {
    for (const std::size_t i : with_other_law(test.campaign, campaign_, fitted_))
      if (std::ranges::find(test.own, i) == test.own.end())
        at.member("case").refuse("a case with a law of its own for the fitted " + quoted(i),
                                 candidate ? "a case with the campaign's laws for what is fitted"
                                           : quoted(i) + " among the test's \"own\" parameters");
  }

  const CaseSpec* read_case(JsonObject& object) const {
    std::string name;
    const auto at = object.find("case");
    if (!at || !at->read(name, "a string, the name of a case")) return nullptr;
    const auto found = std::ranges::find(campaign_.cases, name, &CaseSpec::name);
    if (found != campaign_.cases.end()) return &*found;
    std::vector<std::string> names;
    for (const CaseSpec& spec : campaign_.cases) names.push_back(spec.name);
    at->refuse(fmt::format("\"{}\"", name), "a case of the campaign" + did_you_mean(name, names));
    return nullptr;
  }

  void change_scene_of(JsonObject& object, FitTest& test) const {
    std::vector<CaseChange> changes;
    const auto writers = set_by_draws(campaign_.dispersions);
    const std::size_t before = object.at().problems().size();
    for (std::size_t how = 0; how < apply_names.size(); ++how) {
      const auto at = object.find(apply_names[how]);
      if (!at) continue;
      if (!at->value().is_object())
        at->refuse("an object with numbers by the paths of parameters");
      else
        for (const auto& [path, value] : at->value().items())
          read_change(at->member(path), path, static_cast<Apply>(how), test.campaign.scene,
                      changes);
    }
    for (const CaseChange& change : changes)
      if (const auto found = writers.find(change.target); found != writers.end())
        object.at().refuse(
            fmt::format("a change of {}, which \"{}\" sets in every run",
                        path_of(test.campaign.scene, change.target), found->second),
            "a parameter that no dispersion sets: fit that one, and state its value");
    make_changes(changes, test.campaign.scene);
    for (const Fault& fault : unphysical(test.campaign.scene))
      object.at().refuse(fmt::format("{} of {}", fault.path, fault.found), fault.expected);
    if (object.at().problems().size() == before)
      test.campaign = with_scene(test.campaign, test.campaign.scene);
  }

  void read_trace_of(const JsonCursor& at, bool candidate, FitTest& test) {
    JsonObject object(at, "a trace: an object with file, time and columns");
    std::vector<TraceColumn> columns;
    std::string file;
    bool named = candidate;
    if (candidate) {
      if (const auto times = object.require("times", "an object with to and step"))
        read_times(*times, test);
    } else {
      named = object.required("file", file, "a string, the name of a CSV file");
      columns.push_back({at, "", "", "s", true});
      if (const auto time = object.require("time", "the time's column"))
        if (auto header = read_header(*time, columns.back())) header->refuse_others();
    }
    object.optional("time_offset_std", test.time_offset_std, Dimension{"s", "≥ 0"},
                    is_not_negative);
    test.correlated = correlated_;
    read_truth(object, "correlated", test.correlated);
    constexpr const char* expected = "an object with the measured columns by those of a trajectory";
    if (const auto measured = object.require("columns", expected)) {
      if (!measured->value().is_object() || measured->value().empty())
        measured->refuse(expected);
      else
        for (const auto& [name, value] : measured->value().items())
          read_column(measured->member(name), name, candidate, test, columns);
    }
    object.refuse_others();
    if (!named || candidate || columns.size() < 2) return;
    read_trace(at, directory_ / file, columns);
    test.times = std::move(columns[0].values);
    for (std::size_t i = 0; i < test.columns.size(); ++i)
      test.columns[i].measured = std::move(columns[i + 1].values);
    if (at.problems().empty()) refuse_foreign_trace(test, fitted_, columns);
  }

  /// A header's name, or an object with `column` and `unit`. @return the object's reader
  static std::optional<JsonObject> read_header(const JsonCursor& at, TraceColumn& column) {
    column.at = at;
    if (at.value().is_string()) {
      at.read(column.header, "a column's name in the header");
      return std::nullopt;
    }
    JsonObject object(at, "a column's name in the header, or an object with column and unit");
    object.required("column", column.header, "a string, a column's name in the header");
    object.optional("unit", column.unit, "a string, a unit");
    return object;
  }

  static void read_times(const JsonCursor& at, FitTest& test) {
    JsonObject object(at, "an object with to and step");
    double to = 0, step = 0;
    const bool good = object.required("to", to, Dimension{"s", "> 0"}, is_positive) &&
                      object.required("step", step, Dimension{"s", "> 0"}, is_positive);
    object.refuse_others();
    if (!good || !(step > 0)) return;
    if (to / step > most_candidate_times || to < step)
      return void(at.refuse(fmt::format("{:g} times", to / step + 1), "from 2 to 1e5"));
    for (long k = 0; static_cast<double>(k) * step <= to; ++k)
      test.times.push_back(static_cast<double>(k) * step);
  }

  void read_column(const JsonCursor& at, const std::string& name, bool candidate, FitTest& test,
                   std::vector<TraceColumn>& columns) const {
    const std::vector<std::string> all = trajectory_columns(test.campaign.scene);
    const auto found = std::ranges::find(all, name);
    if (found == all.end() || name == "t") {
      at.refuse(fmt::format("\"{}\"", name),
                "a column of the trajectory" + did_you_mean(name, all));
      return;
    }
    FitColumn column{
        name, static_cast<std::size_t>(found - all.begin()), unit_of_column(name), std::nullopt, 0,
        {}};
    TraceColumn recorded{at, "", "", column.unit};
    std::optional<JsonObject> object;
    if (candidate) {
      object.emplace(at, "an object with std");
      column.measured.assign(test.times.size(), 0);
      (void)object->require("std", "a number: a candidate's noise is to be known");
    } else {
      object = read_header(at, recorded);
    }
    if (object) {
      double std = 0;
      const Dimension dimension{column.unit, "> 0"};
      if (object->find("std") && object->optional("std", std, dimension, is_positive))
        column.std = std;
      object->optional("offset_std", column.offset_std, Dimension{column.unit, "≥ 0"},
                       is_not_negative);
      object->refuse_others();
    }
    test.columns.push_back(std::move(column));
    columns.push_back(std::move(recorded));
  }

  void read_values(const JsonCursor& at, bool candidate, FitTest& test) const {
    if (!at.value().is_array() || at.value().empty())
      at.refuse("an array of at least one measured value");
    Outputs outputs;
    for (const JsonCursor& element : at.elements()) read_value(element, candidate, test, outputs);
    test.campaign.outputs = outputs;
    test.campaign.resolved["outputs"] = write_outputs(outputs);
  }

  static void read_value(const JsonCursor& at, bool candidate, FitTest& test, Outputs& outputs) {
    FitValue value;
    const std::size_t before = at.problems().size();
    JsonObject object(at, "a measured value: an object");
    const auto output = object.find("output"), parameter = object.find("parameter");
    if (object.is_object() && output.has_value() == parameter.has_value()) {
      at.refuse(output ? "both an output and a parameter" : "neither an output nor a parameter",
                "one of them");
    } else if (output && output->read(value.name, "a string, the name of an output")) {
      value.unit = parse_output_name(value.name).unit;
      add_measured(*output, value.name, test.campaign.scene, outputs);
    } else if (parameter && parameter->read(value.name, "a string, a parameter's path")) {
      const ParameterMatches found = resolve(test.campaign.scene, value.name);
      if (found.matches.size() == 1) {
        value.parameter = found.matches.front().parameter;
        value.unit = unit_of(*value.parameter);
      } else {
        parameter->refuse(found.matches.empty() ? found.expected : "the path of one parameter");
      }
    }
    if (at.problems().size() > before) return; // the unit is not known
    if (!candidate) object.required("value", value.measured, Dimension{value.unit});
    object.required("std", value.std, Dimension{value.unit, "> 0"}, is_positive);
    object.refuse_others();
    if (std::ranges::find(test.values, value.name, &FitValue::name) != test.values.end())
      at.refuse(fmt::format("a second value of \"{}\"", value.name),
                "one in a test: the mean of several, with its std, or a test for each");
    test.values.push_back(std::move(value));
  }

  void read_own(const JsonCursor& at, FitTest& test) const {
    if (!at.value().is_array()) at.refuse("an array of names of fitted parameters");
    for (const JsonCursor& name : at.elements())
      for (const std::size_t index : read_names(name))
        if (std::ranges::find(fitted_, index) == fitted_.end())
          name.refuse(quoted(index) + ", which is not fitted", "one of fit.parameters");
        else if (std::ranges::find(test.own, index) != test.own.end())
          name.refuse_repeated(quoted(index), "each parameter once");
        else
          test.own.push_back(index);
  }

  [[nodiscard]] std::string quoted(std::size_t dispersion) const {
    return '"' + campaign_.dispersions[dispersion].name + '"';
  }

  const Campaign& campaign_;
  std::filesystem::path directory_;
  std::vector<std::size_t> fitted_;
  bool correlated_ = true;
};

/// Refuses a column of unknown noise with no more samples than unknowns: an exact fit would make the noise 0. Counts all
/// fitted parameters, whether they act on the test or not.
void refuse_few_samples(const FitSpec& spec, const std::string& file, std::vector<Problem>& all) {
  for (std::size_t t = 0; t < spec.tests.size(); ++t) {
    const FitTest& test = spec.tests[t];
    std::set<std::size_t> parameters(spec.parameters.begin(), spec.parameters.end());
    parameters.insert(test.own.begin(), test.own.end());
    for (const FitColumn& column : test.columns) {
      const std::size_t unknowns =
          parameters.size() + (test.time_offset_std > 0) + (column.offset_std > 0);
      if (column.std || test.times.size() > unknowns) continue;
      all.push_back({file, fmt::format("/tests/{}/trace/columns{}", t, pointer_token(column.name)),
                     fmt::format("{} for {}, offsets included",
                                 counted(static_cast<long>(test.times.size()), "sample", "samples"),
                                 counted(static_cast<long>(unknowns), "unknown", "unknowns")),
                     "more samples than unknowns, or the noise \"std\""});
    }
  }
}

} // namespace

FitSpec read_fit(const Json& document, const std::string& file,
                 const std::filesystem::path& directory, const Campaign& campaign) {
  FitSpec spec;
  std::vector<Problem> problems;
  FitReader(campaign, directory).read(JsonCursor(document, file, problems), spec);
  if (problems.empty()) refuse_few_samples(spec, file, problems);
  if (!problems.empty()) throw SpecError(std::move(problems));
  spec.resolved = document;
  return spec;
}

FitSpec read_fit_file(const std::filesystem::path& path, const Campaign& campaign) {
  return read_fit(parse_json_file(path), path.string(), path.parent_path(), campaign);
}

} // namespace wingspread
