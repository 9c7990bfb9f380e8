/// Reads values from a JSON document and collects all problems with their pointers.
///
///     JsonObject object(at, "a body");
///     object.required("mass", body.mass, Dimension{"kg", "> 0"}, is_positive);
///     object.optional("name", body.name, "a string");
///     object.refuse_others();
///
/// Readers throw nothing: a value that cannot be read keeps its default, and the problem is in the list. A message
/// names the value as the user wrote it (`string "5 deg/s"`), not in SI.
#pragma once

#include "montecarlo/foundation/formats/json_parse.hpp"
#include "montecarlo/foundation/formats/quantity.hpp"
#include "montecarlo/foundation/formats/spec_error.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// The longest list in a document (bodies, dispersions, requirements). The cost of some checks grows as its square.
inline constexpr std::size_t most_elements = 1000;

/// A JSON value in a message: `-1`, `string "abc"`, `an array of 3`, `an object`.
[[nodiscard]] std::string describe_value(const Json& value);

/// A number as the user wrote it: `1.5`, `"90 deg"`.
[[nodiscard]] std::string as_written(const Json& value);

/// `"a", "b" or "c"`.
[[nodiscard]] std::string quoted_list(std::span<const std::string_view> words);

/// A question that a reader asked of a document: a key, a type or a condition. Schemas are made from these questions
/// (model/schema).
struct Question {
  enum class What {
    object,
    names,
    key,
    required_key,
    number,
    integer,
    text,
    quantity,
    pair,
    choice
  };
  What what;
  std::string pointer;              ///< of the value
  std::string expected;             ///< the message's words; may be empty
  std::string key{};                ///< a member's key, or the name of a kind of object
  std::vector<std::string> words{}; ///< of a choice
};

/// A value of a document and its pointer. Problems go to the list given to the constructor.
class JsonCursor {
public:
  /// The whole document. @pre all arguments outlive the cursor and all cursors made from it
  /// @param file      name for the messages
  /// @param questions receives all questions in order; may be null
  JsonCursor(const Json& document, std::string file, std::vector<Problem>& problems,
             std::vector<Question>* questions = nullptr);

  [[nodiscard]] const Json& value() const { return *value_; }
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] const std::string& pointer() const { return pointer_; }
  [[nodiscard]] std::vector<Problem>& problems() const { return *problems_; }

  /// @pre value() is an object that holds the key
  [[nodiscard]] JsonCursor member(std::string_view key) const;
  /// @pre value() is an array with more than `index` elements
  [[nodiscard]] JsonCursor element(std::size_t index) const;
  /// The elements. Empty if the value is no array; empty, with a problem, if there are more than `most`.
  [[nodiscard]] std::vector<JsonCursor> elements(std::size_t most = most_elements) const;

  /// Notes a problem at this value; returns false, so that a reader can return the result.
  /// @param found default: describe_value
  /// @param below appended to the pointer, for a missing member
  bool refuse(std::string_view expected) const;
  bool refuse(std::string_view found, std::string_view expected, std::string_view below = "") const;

  /// Notes a problem for a repeated value: "3 a second time".
  bool refuse_repeated(std::string_view expected) const;
  bool refuse_repeated(std::string_view what, std::string_view expected) const;

  /// Reads the value. For another type, or an integer out of range: notes a problem, keeps `out` and returns false.
  bool read(double& out, std::string_view expected) const;
  bool read(std::int64_t& out, std::string_view expected) const;
  bool read(std::uint64_t& out, std::string_view expected) const;
  bool read(std::string& out, std::string_view expected) const;
  bool read(std::vector<double>& out, std::string_view expected) const;

  /// Reads quantities in the same way: SI numbers, or strings with a unit (quantity.hpp).
  bool read(double& out, const Dimension& dimension) const;
  bool read(Eigen::Vector2d& out, const Dimension& dimension) const;
  bool read(std::vector<double>& out, const Dimension& dimension) const;

  /// The index of the value among the words; nothing, with a problem, if it is none of them.
  [[nodiscard]] std::optional<std::size_t> choice(std::span<const std::string_view> words) const;

  /// Records, for the schema, that the value, or each element of an array, is a quantity whose unit other keys decide.
  /// Call it before reading.
  /// @param unit "in the output's unit"
  void note_quantity(std::string_view unit, std::string_view condition = "") const;

  /// Records a question about this value.
  void note(Question::What what, std::string_view expected, std::string_view key = "") const {
    if (questions_)
      questions_->push_back({what, pointer_, std::string(expected), std::string(key)});
  }

private:
  const Json* value_;
  std::string file_, pointer_;
  std::vector<Problem>* problems_;
  std::vector<Question>* questions_;
};

// Conditions for JsonObject.
[[nodiscard]] inline bool is_positive(const double& number) { return number > 0; }
[[nodiscard]] inline bool is_not_negative(const double& number) { return number >= 0; }
[[nodiscard]] inline bool is_proper_share(const double& number) { return number > 0 && number < 1; }

/// Reads the members of an object. The keys that were asked for are the known keys.
class JsonObject {
public:
  /// Notes a problem if the value is no object; then missing members are not reported.
  /// @param what for the message, e.g. "a body"
  JsonObject(const JsonCursor& at, std::string_view what);

  /// The member; nothing if missing.
  [[nodiscard]] std::optional<JsonCursor> find(std::string_view key);
  /// The member; nothing, with a problem, if missing.
  [[nodiscard]] std::optional<JsonCursor> require(std::string_view key, std::string_view expected);

  /// Reads a member into `out`. With a problem: keeps `out` and returns false.
  /// @param expected the condition in words
  /// @param holds    the condition; null: none
  template <class T> using Holds = bool (*)(const T&);
  template <class T>
  bool required(std::string_view key, T& out, std::string_view expected,
                Holds<std::type_identity_t<T>> holds = nullptr) {
    const auto at = require(key, expected);
    return at ? read(*at, out, expected, holds) : !is_object();
  }
  template <class T>
  bool optional(std::string_view key, T& out, std::string_view expected,
                Holds<std::type_identity_t<T>> holds = nullptr) {
    const auto at = find(key);
    return at ? read(*at, out, expected, holds) : true;
  }
  /// Reads a quantity in the same way: an SI number, or a string with a unit.
  template <class T> bool required(std::string_view key, T& out, const Dimension& dimension) {
    const auto at = require(key, expected(out, dimension));
    return at ? at->read(out, dimension) : !is_object();
  }
  template <class T> bool optional(std::string_view key, T& out, const Dimension& dimension) {
    const auto at = find(key);
    return at ? at->read(out, dimension) : true;
  }
  bool optional(std::string_view key, std::optional<double>& out, const Dimension& dimension) {
    double value = 0;
    const auto at = find(key);
    if (!at) return true;
    if (!at->read(value, dimension)) return false;
    out = value;
    return true;
  }
  /// Reads a quantity with a condition; the dimension has the condition in words.
  bool required(std::string_view key, double& out, const Dimension& dimension,
                Holds<double> holds) {
    const auto at = require(key, expected_number(dimension));
    return at ? read(*at, out, dimension, holds) : !is_object();
  }
  bool optional(std::string_view key, double& out, const Dimension& dimension,
                Holds<double> holds) {
    const auto at = find(key);
    return at ? read(*at, out, dimension, holds) : true;
  }
  /// Reads an enumeration. @param words the words of its values, in their order
  template <class Enum>
  bool required_choice(std::string_view key, Enum& out, std::span<const std::string_view> words) {
    const auto at = require(key, quoted_list(words));
    return at ? choose(*at, out, words) : !is_object();
  }
  template <class Enum>
  bool optional_choice(std::string_view key, Enum& out, std::span<const std::string_view> words) {
    const auto at = find(key);
    return at ? choose(*at, out, words) : true;
  }

  /// Declares that the keys are names given by the user (of hinges, say), for the schema.
  void keys_are_names() const { at_.note(Question::What::names, ""); }

  /// Passes over "$schema", by which editors find a document's JSON Schema.
  void pass_over_schema();

  /// Notes a problem for each unknown key, with the nearest known key. Call it last.
  void refuse_others() const;

  [[nodiscard]] bool is_object() const { return at_.value().is_object(); }
  [[nodiscard]] const JsonCursor& at() const { return at_; }

private:
  template <class T>
  static bool read(const JsonCursor& at, T& out, std::string_view expected, Holds<T> holds) {
    T value{};
    if (!at.read(value, expected)) return false;
    if (holds && !holds(value)) return at.refuse(expected);
    out = std::move(value);
    return true;
  }
  static bool read(const JsonCursor& at, double& out, const Dimension& dimension,
                   Holds<double> holds) {
    double value = 0;
    if (!at.read(value, dimension)) return false;
    if (!holds(value)) return at.refuse(expected_number(dimension));
    out = value;
    return true;
  }
  static std::string expected(double, const Dimension& dimension) {
    return expected_number(dimension);
  }
  static std::string expected(const Eigen::Vector2d&, const Dimension& dimension) {
    return expected_numbers(dimension, 2);
  }
  static std::string expected(const std::vector<double>&, const Dimension& dimension) {
    return expected_numbers(dimension);
  }
  template <class Enum>
  static bool choose(const JsonCursor& at, Enum& out, std::span<const std::string_view> words) {
    const auto index = at.choice(words);
    if (index) out = static_cast<Enum>(*index);
    return index.has_value();
  }

  JsonCursor at_;
  std::vector<std::string> known_;
};

} // namespace wingspread
