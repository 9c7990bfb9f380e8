#include "montecarlo/foundation/formats/json_parse.hpp"

#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/spec_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

namespace wingspread {
namespace {

/// "line 3, column 1" of a byte, all counted from 1.
std::string place_in(std::string_view text, std::size_t byte) {
  const std::string_view read = text.substr(0, std::min(byte, text.size()));
  const std::size_t line_start = read.rfind('\n') + 1; // npos + 1 is 0
  return fmt::format("line {}, column {}", 1 + std::ranges::count(read, '\n'), byte - line_start);
}

/// Builds the document from the parser's events and collects problems. The parser's own builder silently keeps the last
/// value of a repeated key.
class DocumentBuilder : public nlohmann::json_sax<Json> {
public:
  DocumentBuilder(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

  Json document;
  std::vector<Problem> problems;

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t& /*as written*/) override {
    return add(value);
  }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t& value) override { return add(std::move(value)); } // JSON has none

  bool start_object(std::size_t /*unknown*/) override { return open(Json::object()); }
  bool start_array(std::size_t /*unknown*/) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& key) override {
    Container& in = open_.back();
    in.key = std::move(key);
    if (in.value->contains(in.key))
      problems.push_back({file_, next_pointer(),
                          fmt::format("the key \"{}\" a second time", in.key), "the key once"});
    return true;
  }

  bool parse_error(std::size_t byte, const std::string& token,
                   const nlohmann::detail::exception& error) override {
    constexpr int number_overflow = 406;
    if (error.id == number_overflow)
      problems = {
          {file_, next_pointer(), "the number " + token, "a number within the range of a double"}};
    else
      problems = {syntax_problem(byte, error.what())};
    return false;
  }

private:
  struct Container {
    Json* value;
    std::string key; ///< key of an object's last member
  };

  /// Adds a value at the parser's position. Returns true: continue parsing.
  bool add(Json value) {
    (void)place(std::move(value));
    return true;
  }

  bool open(Json container) {
    if (open_.size() == most_json_levels) {
      problems.push_back({file_, next_pointer(), "one more level of brackets",
                          fmt::format("at most {}", most_json_levels)});
      return false;
    }
    open_.push_back({place(std::move(container)), {}});
    return true;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  Json* place(Json value) {
    if (open_.empty()) return &(document = std::move(value));
    const auto& [in, key] = open_.back();
    if (in->is_array()) return &in->emplace_back(std::move(value));
    return &((*in)[key] = std::move(value));
  }

  /// The pointer of the next value.
  [[nodiscard]] std::string next_pointer() const {
    std::string pointer;
    for (const auto& [in, key] : open_) {
      const bool innermost = in == open_.back().value;
      pointer +=
          pointer_token(in->is_array() ? std::to_string(in->size() - (innermost ? 0 : 1)) : key);
    }
    return pointer;
  }

  /// @param message "[json.exception…] parse error at …: syntax error … - unexpected '}'; expected
  ///   string literal"
  [[nodiscard]] Problem syntax_problem(std::size_t byte, std::string_view message) const {
    const std::string_view words = message.substr(message.find(": ") + 2);
    const std::size_t mark = words.find("; expected ");
    const std::string_view found = words.substr(0, mark);
    return {file_, "", fmt::format("{}: {}", place_in(text_, byte), found),
            mark == std::string_view::npos ? "valid JSON" : std::string(words.substr(mark + 11))};
  }

  std::string_view text_;
  std::string file_;
  std::vector<Container> open_; ///< from the document inwards
};

} // namespace

std::string pointer_token(std::string_view key) {
  std::string token = "/";
  for (const char c : key) token += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return token;
}

Json parse_json(const std::string& text, const std::string& file) {
  DocumentBuilder builder(text, file);
  (void)Json::sax_parse(text, &builder); // false with problems
  if (!builder.problems.empty()) throw SpecError(std::move(builder.problems));
  if (const std::size_t nul = text.find('\0'); nul != std::string::npos) // to the parser, the end
    throw SpecError(
        {{file, "", fmt::format("{}: a NUL byte", place_in(text, nul + 1)), "JSON text"}});
  return std::move(builder.document);
}

Json parse_json_file(const std::filesystem::path& path) {
  const auto text = read_text(path);
  if (!text) throw SpecError({{path.string(), "", "no file that can be read", "a JSON file"}});
  return parse_json(*text, path.string());
}

} // namespace wingspread
