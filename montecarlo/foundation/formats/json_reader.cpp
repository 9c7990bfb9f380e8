#include "montecarlo/foundation/formats/json_reader.hpp"

#include "montecarlo/foundation/formats/nearest.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace wingspread {
namespace {

constexpr std::size_t longest_shown = 61; // characters of a string in a message

/// The value as an integer; JSON may write it as 10000, 1e4 or 10000.0.
template <class Integer> std::optional<Integer> as_integer(const Json& value) {
  using Limits = std::numeric_limits<Integer>;
  if (value.is_number_unsigned()) {
    const auto number = value.get<std::uint64_t>();
    if (number <= static_cast<std::uint64_t>(Limits::max())) return static_cast<Integer>(number);
  } else if (value.is_number_integer()) {
    const auto number = value.get<std::int64_t>();
    if (std::is_signed_v<Integer> || number >= 0) return static_cast<Integer>(number);
  } else if (value.is_number_float()) {
    const double number = value.get<double>();
    constexpr double exact = 9007199254740992; // 2^53: beyond it a double skips integers
    const double least = std::is_signed_v<Integer> ? -exact : 0;
    if (std::trunc(number) == number && number >= least && number <= exact)
      return static_cast<Integer>(number);
  }
  return std::nullopt;
}

template <class Integer>
bool read_integer(const JsonCursor& at, Integer& out, std::string_view expected) {
  const auto number = as_integer<Integer>(at.value());
  if (!number) return at.refuse(expected);
  out = *number;
  return true;
}

/// Reads all elements of an array; keeps `out` if one cannot be read.
template <class Expected>
bool read_each(const JsonCursor& at, std::vector<double>& out, const Expected& expected) {
  std::vector<double> numbers(at.value().size());
  bool all = true;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    all = at.element(i).read(numbers[i], expected) && all;
  if (all) out = std::move(numbers);
  return all;
}

/// The expectation in a message about a NaN or infinity (these come from options only; JSON has none).
std::string finite(std::string_view expected) {
  constexpr std::string_view number = "a number";
  return expected.starts_with(number)
             ? fmt::format("a finite number{}", expected.substr(number.size()))
             : std::string(expected);
}

} // namespace

std::string describe_value(const Json& value) {
  switch (value.type()) {
  case Json::value_t::number_float: // from an option: JSON has no nan, and writes null for it
    return std::isfinite(value.get<double>()) ? value.dump()
                                              : fmt::format("{}", value.get<double>());
  case Json::value_t::object:
    return "an object";
  case Json::value_t::array:
    return fmt::format("an array of {}", value.size());
  case Json::value_t::string:
    return "string " + as_written(value);
  default:
    return value.dump();
  }
}

std::string as_written(const Json& value) { return shortened(value.dump(), longest_shown); }

std::string quoted_list(std::span<const std::string_view> words) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const char* separator = i == 0 ? "" : i + 1 == words.size() ? " or " : ", ";
    list += fmt::format("{}\"{}\"", separator, words[i]);
  }
  return list;
}

JsonCursor::JsonCursor(const Json& document, std::string file, std::vector<Problem>& problems,
                       std::vector<Question>* questions)
    : value_(&document), file_(std::move(file)), problems_(&problems), questions_(questions) {}

JsonCursor JsonCursor::member(std::string_view key) const {
  JsonCursor at = *this;
  at.value_ = &value_->at(std::string(key));
  at.pointer_ += pointer_token(key);
  return at;
}

JsonCursor JsonCursor::element(std::size_t index) const {
  JsonCursor at = *this;
  at.value_ = &value_->at(index);
  at.pointer_ += fmt::format("/{}", index);
  return at;
}

std::vector<JsonCursor> JsonCursor::elements(std::size_t most) const {
  std::vector<JsonCursor> all;
  if (!value_->is_array()) return all;
  if (value_->size() > most) {
    refuse(fmt::format("at most {} of them", most));
    return all;
  }
  for (std::size_t i = 0; i < value_->size(); ++i) all.push_back(element(i));
  return all;
}

bool JsonCursor::refuse(std::string_view expected) const {
  return refuse(describe_value(*value_), expected);
}

bool JsonCursor::refuse(std::string_view found, std::string_view expected,
                        std::string_view below) const {
  problems_->push_back(
      {file_, pointer_ + std::string(below), std::string(found), std::string(expected)});
  return false;
}

bool JsonCursor::refuse_repeated(std::string_view expected) const {
  return refuse_repeated(describe_value(*value_), expected);
}

bool JsonCursor::refuse_repeated(std::string_view what, std::string_view expected) const {
  return refuse(fmt::format("{} a second time", what), expected);
}

bool JsonCursor::read(double& out, std::string_view expected) const {
  note(Question::What::number, expected);
  if (!value_->is_number()) return refuse(expected);
  if (!std::isfinite(value_->get<double>())) return refuse(finite(expected));
  out = value_->get<double>();
  return true;
}

bool JsonCursor::read(std::int64_t& out, std::string_view expected) const {
  note(Question::What::integer, expected);
  return read_integer(*this, out, expected);
}

bool JsonCursor::read(std::uint64_t& out, std::string_view expected) const {
  note(Question::What::integer, expected);
  return read_integer(*this, out, expected);
}

bool JsonCursor::read(std::string& out, std::string_view expected) const {
  note(Question::What::text, expected);
  if (!value_->is_string()) return refuse(expected);
  out = value_->get<std::string>();
  return true;
}

bool JsonCursor::read(std::vector<double>& out, std::string_view expected) const {
  return value_->is_array() ? read_each(*this, out, std::string_view("a number"))
                            : refuse(expected);
}

bool JsonCursor::read(double& out, const Dimension& dimension) const {
  if (questions_) note(Question::What::quantity, expected_quantity(dimension));
  if (!value_->is_string()) return read(out, expected_number(dimension));
  const auto value = in_unit(value_->get_ref<const std::string&>(), dimension.unit);
  if (!value) return refuse(expected_quantity(dimension));
  out = *value;
  return true;
}

bool JsonCursor::read(Eigen::Vector2d& out, const Dimension& dimension) const {
  if (questions_) note(Question::What::pair, expected_numbers(dimension, 2));
  if (!value_->is_array() || value_->size() != 2) return refuse(expected_numbers(dimension, 2));
  std::vector<double> both;
  if (!read_each(*this, both, dimension)) return false;
  out = {both[0], both[1]};
  return true;
}

bool JsonCursor::read(std::vector<double>& out, const Dimension& dimension) const {
  return value_->is_array() ? read_each(*this, out, dimension)
                            : refuse(expected_numbers(dimension));
}

void JsonCursor::note_quantity(std::string_view unit, std::string_view condition) const {
  if (!questions_) return;
  for (const JsonCursor& each : elements()) each.note_quantity(unit, condition);
  if (value_->is_array()) return;
  note(Question::What::quantity,
       fmt::format("{}, or a string of a number and its unit", expected_number({unit, condition})));
}

std::optional<std::size_t> JsonCursor::choice(std::span<const std::string_view> words) const {
  note(Question::What::choice, quoted_list(words));
  if (questions_) questions_->back().words.assign(words.begin(), words.end());
  if (value_->is_string()) {
    const auto found = std::ranges::find(words, value_->get_ref<const std::string&>());
    if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  }
  const std::string meant =
      value_->is_string()
          ? did_you_mean(value_->get_ref<const std::string&>(), {words.begin(), words.end()})
          : "";
  refuse(quoted_list(words) + meant);
  return std::nullopt;
}

JsonObject::JsonObject(const JsonCursor& at, std::string_view what) : at_(at) {
  at_.note(Question::What::object, what);
  if (!is_object()) at_.refuse(what);
}

std::optional<JsonCursor> JsonObject::find(std::string_view key) {
  at_.note(Question::What::key, "", key);
  if (std::ranges::find(known_, key) == known_.end()) known_.emplace_back(key);
  if (!is_object() || !at_.value().contains(std::string(key))) return std::nullopt;
  return at_.member(key);
}

std::optional<JsonCursor> JsonObject::require(std::string_view key, std::string_view expected) {
  at_.note(Question::What::required_key, expected, key);
  auto found = find(key);
  if (!found && is_object()) at_.refuse("nothing", expected, pointer_token(key));
  return found;
}

void JsonObject::pass_over_schema() {
  std::string unused;
  optional("$schema", unused, "a string, the address of a JSON Schema, for editors");
}

void JsonObject::refuse_others() const {
  if (!is_object()) return;
  const std::vector<std::string_view> words(known_.begin(), known_.end());
  for (const auto& [key, value] : at_.value().items()) {
    if (std::ranges::find(known_, key) != known_.end()) continue;
    at_.member(key).refuse(fmt::format("the unknown key \"{}\"", key),
                           quoted_list(words) + did_you_mean(key, known_));
  }
}

} // namespace wingspread
