#include "montecarlo/foundation/formats/text_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <sstream>

namespace wingspread {
namespace {

/// Whether the byte is the first byte of a character.
bool starts_character(char byte) { return (static_cast<unsigned char>(byte) & 0xC0) != 0x80; }

/// Heuristic: nobody writes a number with more digits, a conversion to SI has all 17.
constexpr std::size_t most_given_digits = 10;

/// The number with all its digits, or with six if a conversion made them: 56.4924 of "500 in*lbf", which is
/// 56.49241451380835 N·m.
std::string given_digits(double value) {
  const std::string all = fmt::format("{}", value);
  const auto digits = std::ranges::count_if(all, [](char c) { return c >= '0' && c <= '9'; });
  return static_cast<std::size_t>(digits) > most_given_digits ? fmt::format("{:.6g}", value) : all;
}

/// An angle or a rate in degrees. Twelve digits: the conversion from degrees and back costs a rounding.
std::string in_degrees(double value) {
  return fmt::format("{:.12g}", value * 180 / std::numbers::pi);
}

} // namespace

std::size_t count_characters(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, starts_character));
}

std::string shortened(std::string_view text, std::size_t width) {
  if (count_characters(text) <= width) return std::string(text);
  std::size_t end = 0;
  for (std::size_t characters = 0; characters < width; ++end)
    if (starts_character(text[end])) ++characters;
  return std::string(text.substr(0, end - 1)) + "…";
}

std::string in_column(std::string_view text, std::size_t width) {
  const std::size_t length = count_characters(text);
  return std::string(text) +
         (length < width ? std::string(width - length, ' ') : '\n' + std::string(width, ' '));
}

std::string right_aligned(std::string_view text, std::size_t width) {
  const std::size_t length = count_characters(text);
  return std::string(length < width ? width - length : 1, ' ') + std::string(text);
}

std::string wrapped(std::string_view text, std::size_t indent) {
  std::string lines;
  std::size_t column = indent;
  std::istringstream words{std::string(text)};
  for (std::string word; words >> word;) {
    const std::size_t length = count_characters(word);
    if (column == indent) {
      column += length;
    } else if (column + 1 + length <= table_width) {
      lines += ' ';
      column += 1 + length;
    } else {
      lines += '\n' + std::string(indent, ' ');
      column = indent + length;
    }
    lines += word;
  }
  return lines;
}

std::string wrapped_lines(std::string_view text) {
  std::string lines;
  std::istringstream in{std::string(text)};
  for (std::string line; std::getline(in, line);) {
    const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
    const std::string words = line.substr(begin);
    const bool fits = count_characters(line) <= table_width;
    const bool has_columns = words.find("   ") != std::string::npos;
    lines += fits || has_columns ? line : std::string(begin, ' ') + wrapped(words, begin + 4);
    lines += '\n';
  }
  return lines;
}

std::string in_digits(double value) {
  if (std::isnan(value)) return "–";
  std::string text = fmt::format("{:#.5g}", value);
  if (text.ends_with('.')) text.pop_back();
  return text;
}

std::string quantile_name(double p) {
  if (p == 0.5) return "median";
  constexpr int least = 5, most = 15; // digits
  std::string text;
  for (int digits = least; digits <= most; ++digits) {
    text = fmt::format("{:.{}g}", 100 * p, digits);
    if (std::abs(std::stod(text) / 100 - p) < 1e-3 * std::min(p, 1 - p)) break;
  }
  return text + " %";
}

std::string paragraph(std::string_view text, std::size_t indent) {
  const std::string lines = wrapped(text, indent);
  return lines.empty() ? "" : std::string(indent, ' ') + lines + '\n';
}

std::string percent(double share, int decimals) {
  if (std::isnan(share)) return "–";
  constexpr int most = 12; // 1 − share is then near the rounding of a double
  std::string text = fmt::format("{:.{}f} %", 100 * share, decimals);
  while (share < 1 && text.starts_with("100") && decimals < most)
    text = fmt::format("{:.{}f} %", 100 * share, ++decimals);
  return text;
}

namespace {

constexpr double conversion_rounding = 1e-12; // relative: a conversion of units costs some 1e-16

/// A decimal text of the value, moved by one unit of its last digit if it lies on the wrong side: below the value with
/// `sign` 1, above with -1. @param unit of the last digit @param text of a number to nearest
template <class Text>
std::string rounded_to(double value, int sign, double unit, const Text& text) {
  const double nearest = std::strtod(text(value).c_str(), nullptr);
  const bool wrong = sign * (value - nearest) > conversion_rounding * std::abs(value);
  return text(wrong ? nearest + sign * unit : nearest);
}

std::string percent_towards(double share, int decimals, int sign) {
  if (std::isnan(share)) return "–";
  const auto text = [&](double percents) { return fmt::format("{:.{}f}", percents, decimals); };
  return rounded_to(100 * share, sign, std::pow(10, -decimals), text) + " %";
}

} // namespace

std::string percent_at_least(double share, int decimals) {
  return percent_towards(share, decimals, -1);
}

std::string percent_at_most(double share, int decimals) {
  return percent_towards(share, decimals, 1);
}

std::string in_digits_towards(double value, int sign, int digits) {
  if (!std::isfinite(value) || value == 0) return in_digits(value);
  const auto text = [&](double number) {
    std::string its = fmt::format("{:#.{}g}", number, digits);
    if (its.ends_with('.')) its.pop_back();
    return its;
  };
  const double power = std::floor(std::log10(std::abs(value)));
  return rounded_to(value, sign, std::pow(10, power - digits + 1), text);
}

std::string in_digits_beside(double value, double limit, int sign) {
  constexpr int least = 5, most = 17; // all of a double's
  std::string shown = in_digits(value);
  if (!std::isfinite(value) || value == 0) return shown;
  const auto is_at = [&](double x) {
    return std::abs(x - limit) <= conversion_rounding * std::abs(limit);
  };
  for (int digits = least; digits <= most; ++digits) {
    shown = in_digits_towards(value, sign, digits);
    const double read = std::strtod(shown.c_str(), nullptr);
    if (is_at(value) ? is_at(read) : read != limit && (read < limit) == (value < limit)) break;
  }
  return shown;
}

namespace {

/// The decimals, at most 12, that show two digits of a number of per cent; 1 − a share is then near the rounding of a
/// double.
int decimals_of(double percents) {
  return std::min(12, 1 - static_cast<int>(std::floor(std::log10(percents))));
}

} // namespace

std::string percent_range(double lower, double upper) {
  constexpr double shown = 0.0005; // per cent: three decimals round less away
  int decimals = 3;
  for (const double bound : {lower, upper})
    if (const double distance = 100 * std::min(bound, 1 - bound); distance > 0 && distance < shown)
      decimals = std::max(decimals, decimals_of(distance));
  if (decimals == 3) return fmt::format("{:.3f} – {:.3f} %", 100 * lower, 100 * upper);
  const double scale = std::pow(10, decimals + 2);
  return fmt::format("{:.{}f} – {:.{}f} %", 100 * std::floor(lower * scale) / scale, decimals,
                     100 * std::ceil(upper * scale) / scale, decimals);
}

std::string degrees_text(double radians) {
  const double degrees = radians * 180 / std::numbers::pi;
  return fmt::format("{:.4g}", degrees == 0 ? 0 : degrees); // no "-0"
}

double factor_as_written(double limit, std::string_view unit) {
  if (unit != "rad" && unit != "rad/s") return 1;
  const double degrees = 180 / std::numbers::pi;
  return in_degrees(limit).size() < fmt::format("{}", limit).size() ? degrees : 1;
}

std::string as_written(double value, std::string_view unit) {
  const std::string number = given_digits(value);
  if (factor_as_written(value, unit) == 1)
    return unit.empty() ? number : fmt::format("{} {}", number, unit);
  const std::string degrees = in_degrees(value);
  const bool is_exact = degrees.size() <= most_given_digits;
  return fmt::format("{} deg{}",
                     is_exact ? degrees : fmt::format("{:.6g}", value * 180 / std::numbers::pi),
                     unit.substr(3));
}

int digits_that_tell(std::span<const double> ascending, int least) {
  constexpr int most = 17; // all of a double's
  const auto alike = [&](int digits) {
    return std::ranges::adjacent_find(ascending, [&](double a, double b) {
             return a != b &&
                    fmt::format("{:.{}g}", a, digits) == fmt::format("{:.{}g}", b, digits);
           }) != ascending.end();
  };
  int digits = least;
  while (digits < most && alike(digits)) ++digits;
  return digits;
}

std::string spaced(std::string_view name) {
  std::string words(name);
  std::ranges::replace(words, '_', ' ');
  return words;
}

std::string counted(long count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

} // namespace wingspread
