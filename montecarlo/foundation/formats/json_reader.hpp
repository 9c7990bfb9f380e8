/// Reads values out of a JSON document, and collects every problem on the way with its pointer.
///
///     JsonObject object(at, "a body");
///     object.required("mass", body.mass, "a number, kg, > 0");
///     object.optional("inertia", body.inertia, "a number, kg·m², > 0");
///     object.refuse_others();
///
/// Nothing is thrown: what could not be read keeps the value it had, and the problem is in the
/// list.
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

/// Of a list that people write: bodies, dispersions, requirements. Some of what is done with them takes the square
/// of their number.
inline constexpr std::size_t most_elements = 1000;

/// What a JSON value is, for a message: `-1`, `string "abc"`, `an array of 3`, `an object`.
[[nodiscard]] std::string describe_value(const Json& value);

/// `"a", "b" or "c"`.
[[nodiscard]] std::string quoted_list(std::span<const std::string_view> words);

/// Something that a reader has asked of a document: what schemas are made of (schema/).
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
  std::string pointer;              ///< of the value that was asked
  std::string expected;             ///< for people; may be empty
  std::string key{};                ///< of an object, or the name of its kind
  std::vector<std::string> words{}; ///< of a choice
};

/// A value of the document and its place. Problems found there go to the list it was made with.
class JsonCursor {
public:
  /// The whole document. @pre all outlive the cursor and all that are made from it
  /// @param questions gets all that is asked of the document, in its order; null: nobody wants to know
  JsonCursor(const Json& document, std::string file, std::vector<Problem>& problems,
             std::vector<Question>* questions = nullptr);

  [[nodiscard]] const Json& value() const { return *value_; }
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] const std::string& pointer() const { return pointer_; }
  [[nodiscard]] std::vector<Problem>& problems() const { return *problems_; }

  /// @pre value() is an object that holds the key
  [[nodiscard]] JsonCursor member(std::string_view key) const;
  /// @pre value() is an array longer than that
  [[nodiscard]] JsonCursor element(std::size_t index) const;
  /// The elements; nothing when it is no array, and a problem and nothing when there are more.
  [[nodiscard]] std::vector<JsonCursor> elements(std::size_t most = most_elements) const;

  /// Notes a problem here; returns false, for the caller to hand on. `below` is appended to the
  /// pointer, for what is missing and has no value of its own.
  bool refuse(std::string_view expected) const;
  bool refuse(std::string_view found, std::string_view expected, std::string_view below = "") const;

  /// The same for a value that is there before: "3 a second time".
  bool refuse_repeated(std::string_view expected) const;
  bool refuse_repeated(std::string_view what, std::string_view expected) const;

  /// Reads the value. When it is of another type, or an integer out of its type's range, notes the
  /// problem, leaves `out` as it was and returns false.
  bool read(double& out, std::string_view expected) const;
  bool read(std::int64_t& out, std::string_view expected) const;
  bool read(std::uint64_t& out, std::string_view expected) const;
  bool read(std::string& out, std::string_view expected) const;
  bool read(std::vector<double>& out, std::string_view expected) const;

  /// The same for numbers that have a dimension: a string with a unit of it will do too.
  bool read(double& out, const Dimension& dimension) const;
  bool read(Eigen::Vector2d& out, const Dimension& dimension) const;
  bool read(std::vector<double>& out, const Dimension& dimension) const;

  /// The index of the word that stands here; a problem and nothing when it is none of them.
  [[nodiscard]] std::optional<std::size_t> choice(std::span<const std::string_view> words) const;

  /// Notes that something is asked here.
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

// What numbers have to hold, for JsonObject below.
[[nodiscard]] inline bool is_positive(const double& number) { return number > 0; }
[[nodiscard]] inline bool is_not_negative(const double& number) { return number >= 0; }
[[nodiscard]] inline bool is_proper_share(const double& number) { return number > 0 && number < 1; }

/// The members of an object. Remembers the keys it was asked for: they are the known ones.
class JsonObject {
public:
  /// Notes a problem when the value is no object; then no member is missed.
  /// @param what for the message, e.g. "a body"
  JsonObject(const JsonCursor& at, std::string_view what);

  /// The member, if there.
  [[nodiscard]] std::optional<JsonCursor> find(std::string_view key);
  /// The member; a problem and nothing when it is not there.
  [[nodiscard]] std::optional<JsonCursor> require(std::string_view key, std::string_view expected);

  /// Each reads a member into `out`, which stays as it was when that cannot be done, and returns
  /// false when it noted a problem. `holds` says which values will do; `expected` says it in words.
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
  /// Of numbers that have a dimension, SI or strings with their units.
  template <class T> bool required(std::string_view key, T& out, const Dimension& dimension) {
    const auto at = require(key, expected(out, dimension));
    return at ? at->read(out, dimension) : !is_object();
  }
  template <class T> bool optional(std::string_view key, T& out, const Dimension& dimension) {
    const auto at = find(key);
    return at ? at->read(out, dimension) : true;
  }
  /// The same for numbers that not all will do: `holds` is what the dimension's condition says.
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
  /// Of words that stand in the order of the enumeration's values.
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

  /// Says that its keys are names from elsewhere, and not those of a format.
  void keys_are_names() const { at_.note(Question::What::names, ""); }

  /// Notes a problem for each key that was not asked for, with the known one nearest to it.
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
