#include "montecarlo/foundation/formats/quantity.hpp"

#include "montecarlo/foundation/formats/json_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace wingspread {
namespace {

/// factor × m^a kg^b s^c rad^d, with powers {a, b, c, d}.
struct Unit {
  long double factor = 1;
  std::array<double, 4> powers{};
};

struct Symbol {
  std::string_view name;
  Unit unit;
};

constexpr long double pi = std::numbers::pi_v<long double>;
constexpr long double inch = 0.0254L, foot = 12 * inch, pound = 0.45359237L;
constexpr long double gravity = 9.80665L, pound_force = pound * gravity;
namespace powers {
using Exponents = std::array<double, 4>; // of m, kg, s, rad
constexpr Exponents length{1, 0, 0, 0}, mass{0, 1, 0, 0}, duration{0, 0, 1, 0}, angle{0, 0, 0, 1},
    rate{0, 0, -1, 1}, frequency{0, 0, -1, 0}, acceleration{1, 0, -2, 0}, force{1, 1, -2, 0},
    torque{2, 1, -2, 0};
} // namespace powers

constexpr std::array symbols{
    Symbol{"m", {1, powers::length}},
    Symbol{"mm", {0.001L, powers::length}},
    Symbol{"cm", {0.01L, powers::length}},
    Symbol{"km", {1000, powers::length}},
    Symbol{"in", {inch, powers::length}},
    Symbol{"ft", {foot, powers::length}},
    Symbol{"kg", {1, powers::mass}},
    Symbol{"g", {0.001L, powers::mass}},
    Symbol{"lb", {pound, powers::mass}},
    Symbol{"lbm", {pound, powers::mass}},
    Symbol{"slug", {pound_force / foot, powers::mass}},
    Symbol{"s", {1, powers::duration}},
    Symbol{"ms", {0.001L, powers::duration}},
    Symbol{"min", {60, powers::duration}},
    Symbol{"h", {3600, powers::duration}},
    Symbol{"rad", {1, powers::angle}},
    Symbol{"mrad", {0.001L, powers::angle}},
    Symbol{"deg", {pi / 180, powers::angle}},
    Symbol{"°", {pi / 180, powers::angle}},
    Symbol{"rev", {2 * pi, powers::angle}},
    Symbol{"rpm", {2 * pi / 60, powers::rate}},
    Symbol{"Hz", {1, powers::frequency}},
    Symbol{"mHz", {0.001L, powers::frequency}},
    Symbol{"kHz", {1000, powers::frequency}},
    Symbol{"N", {1, powers::force}},
    Symbol{"mN", {0.001L, powers::force}},
    Symbol{"kN", {1000, powers::force}},
    Symbol{"lbf", {pound_force, powers::force}},
    Symbol{"ozf", {pound_force / 16, powers::force}},
    Symbol{"Nm", {1, powers::torque}},
    Symbol{"J", {1, powers::torque}}, // energy, in the same powers as a torque
    Symbol{"mJ", {0.001L, powers::torque}},
    Symbol{"kJ", {1000, powers::torque}},
};
constexpr Unit standard_gravity{gravity, powers::acceleration}; // the other "g"

/// Parses a unit by recursive descent: product of powers of symbols and brackets.
class UnitParser {
public:
  /// @param g the meaning of "g"
  UnitParser(std::string_view text, const Unit& g) : rest_(text), g_(g) {}

  /// Nothing if the text is no unit.
  std::optional<Unit> parse() {
    const Unit unit = product();
    return good_ && rest_.empty() ? std::optional(unit) : std::nullopt;
  }

private:
  bool take(std::string_view token) {
    if (!rest_.starts_with(token)) return false;
    rest_.remove_prefix(token.size());
    return true;
  }

  Unit product() {
    Unit unit = power();
    while (good_) {
      if (take("*") || take("·"))
        multiply(unit, power(), 1);
      else if (take("/"))
        multiply(unit, power(), -1);
      else
        break;
    }
    return unit;
  }

  Unit power() {
    const Unit base = take("(") ? bracketed() : symbol();
    Unit unit;
    multiply(unit, base, exponent());
    return unit;
  }

  Unit bracketed() {
    if (++depth_ > most_brackets) good_ = false;
    const Unit unit = good_ ? product() : Unit{};
    good_ = good_ && take(")");
    return unit;
  }

  double exponent() {
    if (take("²")) return 2;
    if (take("³")) return 3;
    if (!take("^")) return 1;
    double value = 0;
    const auto [last, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    good_ = good_ && error == std::errc{} && std::abs(value) <= most_power;
    rest_.remove_prefix(static_cast<std::size_t>(last - rest_.data()));
    return value;
  }

  Unit symbol() {
    const auto ends = [](char c) {
      return std::string_view(" */^()0123456789").find(c) != std::string_view::npos;
    };
    std::size_t length = 0;
    while (length < rest_.size() && !ends(rest_[length]) &&
           !rest_.substr(length).starts_with("·") && !rest_.substr(length).starts_with("²") &&
           !rest_.substr(length).starts_with("³"))
      ++length;
    const std::string_view name = rest_.substr(0, length);
    rest_.remove_prefix(length);
    if (name == "g") return g_;
    const auto found = std::ranges::find(symbols, name, &Symbol::name);
    good_ = good_ && found != symbols.end();
    return found != symbols.end() ? found->unit : Unit{};
  }

  static void multiply(Unit& unit, const Unit& other, double power) {
    unit.factor *=
        power == 1 ? other.factor : std::pow(other.factor, static_cast<long double>(power));
    for (std::size_t i = 0; i < unit.powers.size(); ++i) unit.powers[i] += power * other.powers[i];
  }

  static constexpr int most_brackets = 8;
  static constexpr double most_power = 8;
  std::string_view rest_;
  Unit g_;
  bool good_ = true;
  int depth_ = 0;
};

bool same_dimension(const Unit& a, const Unit& b) {
  constexpr double rounding = 1e-12; // of fractional powers
  for (std::size_t i = 0; i < a.powers.size(); ++i)
    if (std::abs(a.powers[i] - b.powers[i]) > rounding) return false;
  return true;
}

/// Parses a unit of the wanted dimension, with "g" as gram or gravity; nothing for another dimension.
std::optional<Unit> parse_unit(std::string_view text, const Unit& wanted) {
  const Unit gram = std::ranges::find(symbols, "g", &Symbol::name)->unit;
  for (const Unit& g : {gram, standard_gravity})
    if (const auto unit = UnitParser(text, g).parse(); unit && same_dimension(*unit, wanted))
      return unit;
  return std::nullopt;
}

/// Usual products of units by SI unit, for messages.
constexpr std::array<std::pair<std::string_view, std::string_view>, 12> usual_units{{
    {"rad/s", R"("rad/s", "deg/s" or "rpm")"},
    {"rad/s²", R"("rad/s^2" or "deg/s^2")"},
    {"s/rad", R"("s/rad" or "s/deg")"},
    {"m/s", R"("m/s", "mm/s", "in/s" or "ft/s")"},
    {"m/s²", R"("m/s^2", "g", "in/s^2" or "ft/s^2")"},
    {"kg·m²", R"("kg*m^2", "kg*mm^2", "lb*in^2" or "slug*ft^2")"},
    {"N·m²", R"("N*m^2", "N*mm^2" or "lbf*in^2")"},
    {"kg/m³", R"("kg/m^3" or "lb/ft^3")"},
    {"N·m", R"("N*m", "N*mm", "in*lbf", "in*ozf" or "ft*lbf")"},
    {"N·m/rad", R"("N*m/rad", "N*m/deg", "in*lbf/rad" or "in*lbf/deg")"},
    {"N·m·s/rad", R"("N*m*s/rad", "N*m*s/deg", "in*lbf*s/rad" or "N*m/rpm")"},
    {"J", R"("J", "mJ", "kJ" or "N*m")"},
}};

/// In a torque's message a joule would mislead, although it has the same powers.
bool is_energy(std::string_view name) { return name.ends_with('J'); }

using Names = std::vector<std::string_view>;

/// The symbols of one dimension.
Names symbols_like(const Unit& unit) {
  Names names;
  for (const Symbol& symbol : symbols)
    if (!is_energy(symbol.name) && same_dimension(symbol.unit, unit)) names.push_back(symbol.name);
  return names;
}

/// Whether the text of a unit has the symbol: "s" in "N·m·s/rad", and not in "rad/ms".
bool has_symbol(std::string_view unit, std::string_view symbol) {
  const auto is_letter = [&](std::size_t at) {
    return at < unit.size() &&
           ((unit[at] >= 'a' && unit[at] <= 'z') || (unit[at] >= 'A' && unit[at] <= 'Z'));
  };
  for (std::size_t at = unit.find(symbol); at != std::string_view::npos;
       at = unit.find(symbol, at + 1))
    if ((at == 0 || !is_letter(at - 1)) && !is_letter(at + symbol.size())) return true;
  return false;
}

/// Every symbol that can stand in a unit of the same dimension: those like each symbol of the SI unit.
Names symbols_within(std::string_view unit, const Unit& wanted) {
  Names names = symbols_like(wanted);
  for (const std::string_view si : {"N", "kg", "m", "s", "rad"})
    if (has_symbol(unit, si)) {
      const Names like = symbols_like(std::ranges::find(symbols, si, &Symbol::name)->unit);
      names.insert(names.end(), like.begin(), like.end());
    }
  return names;
}

} // namespace

bool is_unit(std::string_view text) {
  return !text.empty() && UnitParser(text, {}).parse().has_value();
}

std::optional<double> in_unit(std::string_view text, std::string_view unit) {
  double number = 0;
  const auto [last, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(last - text.data()));
  if (text.starts_with(' ')) text.remove_prefix(1);
  const std::optional<Unit> wanted = UnitParser(unit, {}).parse();
  const std::optional<Unit> given = wanted ? parse_unit(text, *wanted) : std::nullopt;
  if (!given) return std::nullopt;
  // In extended precision, so that "350 mm" reads as exactly the double 0.35.
  const auto value =
      static_cast<double>(static_cast<long double>(number) * (given->factor / wanted->factor));
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::string units_like(std::string_view unit) {
  const auto known =
      std::ranges::find(usual_units, unit, &std::pair<std::string_view, std::string_view>::first);
  if (unit == "J") return std::string(known->second);
  const std::optional<Unit> wanted = UnitParser(unit, {}).parse();
  if (!wanted) return fmt::format("\"{}\"", unit);
  if (std::ranges::find(symbols, unit, &Symbol::name) != symbols.end())
    return quoted_list(symbols_like(*wanted));
  return fmt::format("{}, or another one made of {}",
                     known != usual_units.end() ? std::string(known->second)
                                                : fmt::format("\"{}\"", unit),
                     fmt::join(symbols_within(unit, *wanted), ", "));
}

std::string expected_number(const Dimension& dimension) {
  std::string text = "a number";
  for (const std::string_view part : {dimension.unit, dimension.condition})
    if (!part.empty()) text += fmt::format(", {}", part);
  return text;
}

std::string expected_quantity(const Dimension& dimension) {
  const std::string number = expected_number(dimension);
  if (dimension.unit.empty()) return number;
  return fmt::format("{}, or a string of a number and its unit: {}", number,
                     units_like(dimension.unit));
}

std::string expected_numbers(const Dimension& dimension, int size) {
  return fmt::format("an array of {}numbers{}{}", size > 0 ? fmt::format("{} ", size) : "",
                     dimension.unit.empty() ? "" : ", ", dimension.unit);
}

} // namespace wingspread
