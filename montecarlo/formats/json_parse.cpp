#include "montecarlo/formats/json_parse.hpp"

#include "montecarlo/formats/spec_error.hpp"

#include <fstream>
#include <iterator>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace wingspread {
namespace {

/// Follows the parser through the document, to find keys that stand twice: the parser itself keeps
/// the last of them without a word.
class KeyWatch {
public:
  explicit KeyWatch(std::string file) : file_(std::move(file)) {}

  void see(Json::parse_event_t event, const Json& parsed) {
    using Event = Json::parse_event_t;
    switch (event) {
    case Event::object_start:
    case Event::array_start:
      count_element();
      open_.push_back({event == Event::array_start, 0, {}, {}});
      break;
    case Event::object_end:
    case Event::array_end:
      open_.pop_back();
      break;
    case Event::key:
      see_key(parsed.get<std::string>());
      break;
    case Event::value:
      count_element();
      break;
    }
  }

  /// Of the value that the parser is about to read.
  std::string next_pointer() {
    count_element();
    return pointer();
  }

  std::vector<Problem> problems;

private:
  struct Container {
    bool array;
    std::size_t elements; // begun so far
    std::string key;      // the last one seen
    std::set<std::string> keys;
  };

  void count_element() {
    if (!open_.empty() && open_.back().array) ++open_.back().elements;
  }

  void see_key(const std::string& key) {
    open_.back().key = key;
    if (!open_.back().keys.insert(key).second)
      problems.push_back({file_, pointer(), "the key \"" + key + "\" a second time", "it once"});
  }

  std::string pointer() const {
    std::string path;
    for (const Container& in : open_)
      path += pointer_token(in.array ? std::to_string(in.elements - 1) : in.key);
    return path;
  }

  std::string file_;
  std::vector<Container> open_;
};

/// The parser's "[json.exception…] parse error at line 3, column 1: syntax error … - unexpected
/// '}'; expected string literal" without its bracket, split into what it found and what it
/// expected.
Problem syntax_problem(const std::string& file, std::string_view message) {
  const auto cut_before = [&message](std::string_view mark) {
    if (const auto at = message.find(mark); at != std::string_view::npos)
      message.remove_prefix(at + mark.size());
  };
  cut_before("] ");
  cut_before("parse error at ");
  const auto at = message.find("; expected ");
  if (at == std::string_view::npos) return {file, "", std::string(message), "valid JSON"};
  return {file, "", std::string(message.substr(0, at)), std::string(message.substr(at + 11))};
}

/// The number in the parser's "number overflow parsing '1e999'".
std::string quoted_number(std::string_view message) {
  const auto first = message.find('\'') + 1;
  return std::string(message.substr(first, message.rfind('\'') - first));
}

} // namespace

std::string pointer_token(std::string_view key) {
  std::string token = "/";
  for (const char c : key) token += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return token;
}

Json parse_json(const std::string& text, const std::string& file) {
  KeyWatch watch(file);
  Json document;
  try {
    document = Json::parse(text, [&watch](int, Json::parse_event_t event, Json& parsed) {
      watch.see(event, parsed);
      return true;
    });
  } catch (const Json::parse_error& error) {
    throw SpecError({syntax_problem(file, error.what())});
  } catch (const Json::out_of_range& error) {
    throw SpecError({{file, watch.next_pointer(), "the number " + quoted_number(error.what()),
                      "a number within the range of a double"}});
  }
  if (!watch.problems.empty()) throw SpecError(std::move(watch.problems));
  return document;
}

std::optional<std::string> read_text(const std::filesystem::path& path) {
  std::error_code unknown; // a path that cannot be asked about cannot be opened either
  std::ifstream in;
  if (!std::filesystem::is_directory(path, unknown)) in.open(path, std::ios::binary);
  if (!in.is_open()) return std::nullopt;
  return std::string{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

Json parse_json_file(const std::filesystem::path& path) {
  const auto text = read_text(path);
  if (!text) throw SpecError({{path.string(), "", "no file that can be read", "a JSON file"}});
  return parse_json(*text, path.string());
}

} // namespace wingspread
