#include "montecarlo/results/results_folder/differences.hpp"

#include "montecarlo/foundation/formats/json_reader.hpp"

#include <fmt/format.h>

namespace wingspread {
namespace {

void add_differences(const Json& found, const Json& expected, const std::string& pointer,
                     std::vector<Difference>& all) {
  if (found.is_object() && expected.is_object()) {
    for (const auto& [key, value] : found.items())
      if (!expected.contains(key)) all.push_back({pointer + pointer_token(key), &value, nullptr});
    for (const auto& [key, value] : expected.items()) {
      const auto there = found.find(key);
      if (there == found.end())
        all.push_back({pointer + pointer_token(key), nullptr, &value});
      else
        add_differences(*there, value, pointer + pointer_token(key), all);
    }
  } else if (found.is_array() && expected.is_array() && found.size() == expected.size()) {
    for (std::size_t i = 0; i < found.size(); ++i)
      add_differences(found[i], expected[i], fmt::format("{}/{}", pointer, i), all);
  } else if (found != expected) {
    all.push_back({pointer, &found, &expected});
  }
}

} // namespace

std::vector<Difference> find_differences(const Json& found, const Json& expected) {
  std::vector<Difference> all;
  add_differences(found, expected, "", all);
  return all;
}

std::string describe_or_nothing(const Json* value) {
  return value ? describe_value(*value) : "nothing";
}

} // namespace wingspread
