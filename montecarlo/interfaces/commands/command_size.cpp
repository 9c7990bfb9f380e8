#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/formats/number_text.hpp"
#include "montecarlo/foundation/formats/spec_error.hpp"
#include "montecarlo/foundation/statistics/wilks.hpp"
#include "montecarlo/interfaces/commands/command_setup.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"

#include <fmt/format.h>

#include <optional>

namespace wingspread {
namespace {

struct SizeOptions {
  std::optional<double> probability, width, proportion;
  double confidence = 0;
  std::optional<long> order, failures, runs;
  bool two_sided = false, json = false;
};

SpecError too_many(const char* expected) {
  return SpecError({{"", "", fmt::format("more than {} runs", most_runs_sized), expected}});
}

/// How many runs may break the requirement: order − 1 for one-sided limits, 2·order − 1 for two-sided.
long failures_of(const SizeOptions& options) {
  if (options.failures) return *options.failures;
  const long order = options.order.value_or(1);
  return (options.two_sided ? 2 * order : order) - 1;
}

struct Answer {
  Json json;
  std::string text;
};

/// The number of runs that shows P ≥ p.
Answer runs_needed(const SizeOptions& options) {
  const double p = *options.probability, c = options.confidence;
  const long k = failures_of(options);
  const auto runs = runs_to_show(p, c, k);
  if (!runs) throw too_many("a probability and an order that fewer can show");
  const long order = options.two_sided ? (k + 1) / 2 : k + 1;
  return {
      {{"probability", p},
       {"confidence", c},
       {"order", order},
       {"two_sided", options.two_sided},
       {"failures", k},
       {"runs", *runs}},
      fmt::format("{} runs show a probability of {} with confidence {}: {} of them may break the "
                  "requirement\n({}-sided tolerance limits of order {})\n",
                  *runs, p, c, k, options.two_sided ? "two" : "one", order)};
}

/// How many of --runs may break the requirement.
Answer failures_allowed(const SizeOptions& options) {
  const double p = *options.probability, c = options.confidence;
  const auto allowed = allowed_failures(*options.runs, p, c);
  const auto least = runs_to_show(p, c, 0);
  Json json{{"probability", p},
            {"confidence", c},
            {"runs", *options.runs},
            {"failures", allowed ? Json(*allowed) : Json(nullptr)},
            {"least_runs", least ? Json(*least) : Json(nullptr)}};
  if (allowed)
    return {json, fmt::format("{} of {} runs may break a requirement of probability {} with "
                              "confidence {}\n",
                              *allowed, *options.runs, p, c)};
  return {json, fmt::format("{} runs cannot show a probability of {} with confidence {}, even if "
                            "none breaks the requirement: that takes {}\n",
                            *options.runs, p, c,
                            least ? std::to_string(*least)
                                  : fmt::format("more than {}", most_runs_sized))};
}

/// The number of runs for which the interval of a share is --width wide.
Answer runs_for_share(const SizeOptions& options) {
  const double width = *options.width, proportion = options.proportion.value_or(0.5);
  const auto runs = runs_for_width(width, options.confidence, proportion);
  if (!runs) throw too_many("a width that fewer can reach");
  return {
      {{"width", width},
       {"confidence", options.confidence},
       {"proportion", proportion},
       {"runs", *runs}},
      fmt::format(
          "{} runs give a share near {} an interval {} wide, from lower to upper bound, "
          "with confidence {} (Clopper–Pearson, two-sided, interpolated between whole counts)\n",
          *runs, proportion, width, options.confidence)};
}

int size(const SizeOptions& options) {
  const Answer answer = options.width  ? runs_for_share(options)
                        : options.runs ? failures_allowed(options)
                                       : runs_needed(options);
  fmt::print("{}", options.json ? json_text(answer.json) : answer.text);
  return exit_code::done;
}

/// Takes numbers from 0 to 1 only. @param whole whether 0 and 1 are among them
CLI::Option* share(CLI::Option* option, bool whole) {
  const std::string limits = whole ? "from 0 to 1" : "> 0 and < 1";
  const auto refuse = [=](const std::string& text) -> std::string {
    const auto value = parse_number<double>(text);
    const bool fits = value && (whole ? 0 <= *value && *value <= 1 : 0 < *value && *value < 1);
    return fits ? ""
                : fmt::format("found {}, expected a number{} {}", text, whole ? "" : ",", limits);
  };
  return limited(option->check(refuse), limits);
}

void add_questions(CLI::App& command, SizeOptions& options) {
  auto* probability = share(command.add_option("--probability", options.probability,
                                               "The probability to be shown, e.g. 0.9973"),
                            false);
  share(command.add_option("--confidence", options.confidence,
                           "The confidence: one-sided, or of the interval of --width"),
        false)
      ->required();
  auto* order = within(command.add_option("--order", options.order,
                                          "Order of the tolerance limit (1: the largest)"),
                       1, most_runs_sized)
                    ->needs(probability);
  auto* two_sided =
      command.add_flag("--two-sided", options.two_sided, "Tolerance limits on both sides")
          ->needs(probability);
  auto* failures = within(command.add_option("--failures", options.failures,
                                             "Runs that may break it; default: order - 1"),
                          0, most_runs_sized)
                       ->needs(probability)
                       ->excludes(order)
                       ->excludes(two_sided);
  within(command.add_option("--runs", options.runs, "Ask how many of these runs may break it"), 1,
         most_runs_sized)
      ->needs(probability)
      ->excludes(order)
      ->excludes(two_sided)
      ->excludes(failures);
  auto* width = share(command.add_option("--width", options.width,
                                         "Whole width of a share's confidence interval"),
                      false)
                    ->excludes(probability);
  share(command.add_option("--proportion", options.proportion,
                           "The share expected; default: 0.5 (most runs)"),
        true)
      ->needs(width);
}

} // namespace

void add_size(CLI::App& app, Action& action) {
  const auto options = std::make_shared<SizeOptions>();
  CLI::App* command = app.add_subcommand("size", "Compute how many runs show what is required");
  add_questions(*command, *options);
  command->add_flag("--json", options->json, "Print the answer as JSON");
  refuse_empty_arguments(*command);
  command->footer(R"(The answers hold for independent draws: the design "random".

Example:
  wingspread size --probability 0.9973 --confidence 0.9 --order 2
  wingspread size --probability 0.99 --confidence 0.9 --runs 10000
  wingspread size --width 0.01 --confidence 0.95 --proportion 0.02)");
  command->callback([options, &action] {
    if (!options->probability && !options->width)
      throw CLI::ValidationError("size", "found neither --probability nor --width, expected one");
    action = [options] { return size(*options); };
  });
}

} // namespace wingspread
