#include "montecarlo/interfaces/terminal/command_options.hpp"

#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/foundation/formats/nearest.hpp"
#include "montecarlo/foundation/formats/number_text.hpp"
#include "montecarlo/foundation/formats/quantity.hpp"
#include "montecarlo/foundation/platform/standard_error.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace wingspread {
namespace {

constexpr std::size_t most_warnings =
    30; // heuristic: one screen; with more, the first ones scroll away

/// Gives the option the decimal number from `least` to `most` that its text states, or else refuses the text. The text
/// becomes that number's own: CLI11 would read "010" as octal, "0x10" as 16 and -1 as 2^64 − 1.
template <class Integer>
void take_decimal(CLI::Option* option, Integer least, Integer most, const std::string& expected) {
  const auto convert = [=](std::string& text) -> std::string {
    const auto number = parse_number<Integer>(text);
    if (!number || *number < least || *number > most)
      return fmt::format("found {}, expected {}", text, expected);
    text = fmt::format("{}", *number);
    return "";
  };
  option->transform(CLI::Validator(convert, ""));
}

std::string refuse_shard(const std::string& text) {
  if (parse_shard(text)) return "";
  return fmt::format("found {}, expected I/N with whole numbers 1 ≤ I ≤ N ≤ {}", text, most_shards);
}

} // namespace

CLI::Option* limited(CLI::Option* option, std::string_view limits) {
  std::string text = option->get_description();
  text.insert(std::min(text.find("; default"), text.size()), fmt::format(", {}", limits));
  return option->description(text);
}

CLI::Option* within(CLI::Option* option, std::int64_t least, std::int64_t most) {
  const bool open = most == std::numeric_limits<std::int64_t>::max();
  const std::string limits =
      open ? fmt::format("at least {}", least) : fmt::format("from {} to {}", least, most);
  take_decimal(option, least, most, "a whole number " + limits);
  return limited(option, limits);
}

CLI::Option* one_of(CLI::Option* option, std::vector<std::string> words) {
  const auto refuse = [words = std::move(words)](const std::string& text) -> std::string {
    if (std::ranges::find(words, text) != words.end()) return "";
    const std::vector<std::string_view> listed(words.begin(), words.end());
    return fmt::format("found \"{}\", expected {}{}", text, quoted_list(listed),
                       did_you_mean(text, words));
  };
  return option->check(refuse);
}

std::optional<double> parse_quantity(std::string_view text, std::string_view unit) {
  if (const auto number = parse_number<double>(text)) return number;
  return in_unit(text, unit);
}

CLI::Option* with_unit(CLI::Option* option, std::string_view unit) {
  const auto convert = [unit = std::string(unit)](std::string& text) -> std::string {
    const auto value = parse_quantity(text, unit);
    if (!value) return fmt::format("found \"{}\", expected {}", text, expected_quantity({unit}));
    text = fmt::format("{}", *value);
    return "";
  };
  return option->transform(CLI::Validator(convert, ""));
}

std::vector<std::string> entries_of(const char* option, std::span<const std::string> given) {
  std::vector<std::string> entries;
  for (const std::string& text : given)
    for (std::size_t first = 0; first <= text.size();) {
      const std::size_t behind = std::min(text.find(',', first), text.size());
      if (behind == first)
        throw SpecError({{"", option, fmt::format("\"{}\", with an entry that is empty", text),
                          "a name or number between any two commas (a list with spaces after its "
                          "commas is written in quotation marks)"}});
      entries.push_back(text.substr(first, behind - first));
      first = behind + 1;
    }
  return entries;
}

void add_seed_option(CLI::App& command, std::optional<std::uint64_t>& seed) {
  CLI::Option* option =
      limited(command.add_option("--seed", seed, "The seed; default: the campaign's"),
              "from 0 to 2^64 - 1")
          ->type_name("N");
  take_decimal(option, std::numeric_limits<std::uint64_t>::min(),
               std::numeric_limits<std::uint64_t>::max(), "an integer from 0 to 2^64 - 1");
}

void add_sampling_options(CLI::App& command, SamplingOptions& sampling) {
  within(command.add_option("--runs", sampling.runs, "Number of runs; default: the campaign's"), 1,
         most_runs)
      ->type_name("N");
  add_seed_option(command, sampling.seed);
}

void add_shard_option(CLI::App& command, std::string& shard, const char* description) {
  command.add_option("--shard", shard, description)->type_name("I/N")->check(refuse_shard);
}

std::optional<Shard> parse_shard(std::string_view text) {
  const std::size_t slash = std::min(text.find('/'), text.size());
  const auto index = parse_number<long>(text.substr(0, slash));
  const auto of = parse_number<long>(text.substr(std::min(slash + 1, text.size())));
  if (!index || !of || *index < 1 || *index > *of || *of > most_shards) return std::nullopt;
  return Shard{*index, *of};
}

void add_confidence_option(CLI::App& command, std::optional<double>& confidence) {
  limited(command.add_option("--confidence", confidence,
                             "Confidence of all bounds; default: the campaign's"),
          "> 0 and < 1");
}

void add_requirements_option(CLI::App& command, std::filesystem::path& file) {
  command
      .add_option("--requirements", file,
                  "Other requirements: an array, a campaign, or a summary.json")
      ->type_name("FILE");
}

double confidence_of(const std::optional<double>& given, const StatisticsSpec& own) {
  StatisticsSpec spec = own;
  Json settings = Json::object();
  if (given) settings["confidence"] = *given;
  override_settings(settings, [&](const JsonCursor& at) { read_statistics(at, spec); });
  return spec.confidence;
}

void add_strict_option(CLI::App& command, bool& strict) {
  command.add_flag("--strict", strict, "Treat warnings as errors: do nothing, exit code 2");
}

void print_warnings(const std::vector<InputWarning>& warnings, bool strict) {
  if (strict && !warnings.empty()) throw as_errors(warnings);
  for (std::size_t i = 0; i < std::min(warnings.size(), most_warnings); ++i)
    print_message("warning: {}\n", to_string(warnings[i]));
  if (warnings.size() > most_warnings)
    print_message("warning: and {} more\n", warnings.size() - most_warnings);
}

void add_set_option(CLI::App& command, std::vector<std::string>& changes) {
  command
      .add_option("--set", changes, "Change the nominal scene, e.g. hinges.root.spring.scale=0.9")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
}

void add_case_option(CLI::App& command, std::string& name, const std::string& more) {
  command.add_option("--case", name, "The case, for a campaign with cases" + more)
      ->type_name("NAME");
}

} // namespace wingspread
