#include "montecarlo/model/scene_file/torque_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <numeric>
#include <utility>

namespace wingspread {
namespace {

constexpr Dimension torque_dimension{"N·m"};

/// Refuses keys that contradict another key.
void refuse_beside(JsonObject& object, std::initializer_list<std::string_view> keys,
                   std::string_view other) {
  for (const std::string_view key : keys)
    if (const auto at = object.find(key)) at->refuse(fmt::format("no {} beside a {}", key, other));
}

/// Notes the first angle that is not further along the travel than the angle before; returns false if there is one.
bool check_order(const JsonCursor& at, const std::vector<double>& angle, Way way) {
  const double sense = way == Way::unknown ? angle[1] - angle[0] : way == Way::up ? 1 : -1;
  for (std::size_t k = 1; k < angle.size(); ++k)
    if (!((angle[k] - angle[k - 1]) * sense > 0))
      return at.element(k).refuse(
          fmt::format("{} than {}, the angle before: from stowed towards latched",
                      sense < 0 ? "less" : "more", as_written(at.element(k - 1).value())));
  return true;
}

bool read_angles(JsonObject& table, Way way, std::vector<double>& angle) {
  const std::string expected = expected_column("rad");
  const auto at = table.require("angle", expected);
  if (!at || !at->read(angle, Dimension{"rad"})) return false;
  if (!can_be_knots(angle.size())) return at->refuse(expected);
  return check_order(*at, angle, way);
}

bool read_torques(JsonObject& table, std::string_view key, const std::vector<double>& angle,
                  std::vector<double>& torque) {
  const auto at = table.require(key, expected_column("N·m"));
  return at && read_column_beside(*at, angle, "angles", torque_dimension, torque);
}

/// Stores the table; notes a problem if its curves overflow because knots nearly coincide.
void store(const JsonCursor& at, TorqueTable table, HingeTorque& torque) {
  if (is_finite(table.drive()) && is_finite(table.friction()))
    torque.table = std::make_shared<const TorqueTable>(std::move(table));
  else
    at.refuse("a curve that overflows", "angles further apart, or smaller torques");
}

void read_table(const JsonCursor& at, Way way, Interpolation interpolation, HingeTorque& torque) {
  JsonObject object(
      at, "a table: an object with angle and torque; a monotone cubic (PCHIP) between its points "
          "unless \"interpolation\" is \"linear\", constant beyond its ends");
  std::vector<double> angle, values;
  const bool good =
      read_angles(object, way, angle) && read_torques(object, "torque", angle, values);
  (void)object.find("torque"); // a known key, even if the angles have problems
  object.refuse_others();
  if (good) store(at, TorqueTable(std::move(angle), std::move(values), interpolation), torque);
}

/// Notes the first stowing torque below the deploying torque; returns false if there is one.
bool check_hysteresis(JsonObject& test, const std::vector<double>& deploying,
                      const std::vector<double>& stowing) {
  for (std::size_t k = 0; k < stowing.size(); ++k)
    if (stowing[k] < deploying[k])
      return test.find("stowing")->element(k).refuse(
          fmt::format("≥ {}, the deploying torque at that angle",
                      as_written(test.find("deploying")->element(k).value())));
  return true;
}

/// The minimum of a cubic c over [0, h].
double lowest(const std::array<double, 4>& c, double h) {
  const auto value = [&](double u) { return c[0] + u * (c[1] + u * (c[2] + u * c[3])); };
  double least = std::min(value(0), value(h));
  // The roots of c1 + 2 c2 u + 3 c3 u², by the formula without cancellation.
  const double q =
      -(c[2] + std::copysign(std::sqrt(std::max(c[2] * c[2] - 3 * c[1] * c[3], 0.0)), c[2]));
  for (const double u : {q / (3 * c[3]), c[1] / q})
    if (u > 0 && u < h) least = std::min(least, value(u));
  return least;
}

/// Checks that the stowing curve is nowhere below the deploying curve between knots: interpolation can make curves
/// cross that nearly touch at a knot.
bool check_between(const JsonCursor& at, const TorqueTable& table) {
  const auto largest = [](double most, double torque) { return std::max(most, std::abs(torque)); };
  const double scale =
      std::accumulate(table.stowing().begin(), table.stowing().end(), 0.0, largest);
  const std::vector<double>& knots = table.friction().knots();
  for (std::size_t k = 1; k < knots.size(); ++k)
    if (lowest(table.friction().pieces()[k].c, knots[k] - knots[k - 1]) <
        -1e-12 * scale) // rounding
      return at.refuse(
          fmt::format("a stowing curve that falls below the deploying one between {} and {} rad",
                      knots[k - 1], knots[k]),
          "one that nowhere does: more knots there, or \"interpolation\": \"linear\"");
  return true;
}

void read_measured(const JsonCursor& at, Way way, Interpolation interpolation,
                   HingeTorque& torque) {
  JsonObject object(at,
                    "a torque test: an object with angle, deploying and stowing (½ (stowing − "
                    "deploying) is friction: friction.scale scales it, not the spring's scale)");
  std::vector<double> angle, deploying, stowing;
  bool good = read_angles(object, way, angle);
  good = good && read_torques(object, "deploying", angle, deploying);
  good = good && read_torques(object, "stowing", angle, stowing) &&
         check_hysteresis(object, deploying, stowing);
  for (const char* key : {"deploying", "stowing"}) (void)object.find(key);
  object.refuse_others();
  if (!good) return;
  TorqueTable table(std::move(angle), std::move(deploying), std::move(stowing), interpolation);
  if (check_between(at, table)) store(at, std::move(table), torque);
}

void read_line(JsonObject& object, HingeTorque& torque) {
  object.required("torque_stowed", torque.torque_stowed, torque_dimension);
  object.required("torque_latched", torque.torque_latched, torque_dimension);
  if (const auto at = object.find("interpolation")) at->refuse("no interpolation without a table");
}

void read_law(JsonObject& object, Way way, bool both_ways, HingeTorque& torque) {
  const auto table = object.find("table");
  const auto measured = both_ways ? object.find("measured") : std::nullopt;
  if (!table && !measured) return read_line(object, torque);
  Interpolation interpolation = Interpolation::monotone;
  object.optional_choice("interpolation", interpolation, interpolation_names);
  refuse_beside(object, {"torque_stowed", "torque_latched"}, table ? "table" : "torque test");
  if (table && measured)
    measured->refuse("no measured beside a table");
  else if (table)
    read_table(*table, way, interpolation, torque);
  else
    read_measured(*measured, way, interpolation, torque);
}

void read_torque(const JsonCursor& at, std::string_view what, Way way, bool both_ways,
                 HingeTorque& torque) {
  JsonObject object(at, what);
  for (const char* key : {"torque_stowed", "torque_latched", "table"}) (void)object.find(key);
  if (object.is_object()) read_law(object, way, both_ways, torque);
  object.optional("scale", torque.scale, "a number");
  object.optional("offset", torque.offset, torque_dimension);
  object.refuse_others();
}

Json write_table(const TorqueTable& table) {
  if (table.both_ways())
    return {
        {"angle", table.angle()}, {"deploying", table.deploying()}, {"stowing", table.stowing()}};
  return {{"angle", table.angle()}, {"torque", table.deploying()}};
}

} // namespace

std::string expected_column(std::string_view unit) {
  return fmt::format("an array of 2 to {} numbers, {}", most_knots, unit);
}

bool read_column_beside(const JsonCursor& at, const std::vector<double>& knots,
                        std::string_view knots_name, const Dimension& dimension,
                        std::vector<double>& column) {
  if (!at.read(column, dimension)) return false;
  if (column.size() != knots.size())
    return at.refuse(fmt::format("as many numbers as there are {}: {}", knots_name, knots.size()));
  return true;
}

bool check_ascending(const JsonCursor& at, const std::vector<double>& column,
                     std::string_view what) {
  for (std::size_t k = 1; k < column.size(); ++k)
    if (!(column[k] > column[k - 1]))
      return at.element(k).refuse(
          fmt::format("more than {}, the {} before", as_written(at.element(k - 1).value()), what));
  return true;
}

bool is_finite(const Curve& curve) {
  return std::ranges::all_of(curve.pieces(), [](const Curve::Piece& piece) {
    return std::isfinite(piece.integral) &&
           std::ranges::all_of(piece.c, [](double c) { return std::isfinite(c); });
  });
}

void read_spring(const JsonCursor& at, Way way, HingeTorque& spring) {
  read_torque(at, "an object with torque_stowed and torque_latched, a table, or a torque test", way,
              true, spring);
}

void read_harness(const JsonCursor& at, Way way, HingeTorque& harness) {
  read_torque(at, "an object with torque_stowed and torque_latched, or a table", way, false,
              harness);
}

Json write_torque(const HingeTorque& torque) {
  Json json = Json::object();
  if (torque.table) {
    json[torque.table->both_ways() ? "measured" : "table"] = write_table(*torque.table);
    json["interpolation"] =
        interpolation_names[static_cast<std::size_t>(torque.table->interpolation())];
  } else {
    json["torque_stowed"] = torque.torque_stowed;
    json["torque_latched"] = torque.torque_latched;
  }
  // Written only where they have an effect: a scene's hash depends on the JSON.
  if (torque.scale != 1) json["scale"] = torque.scale;
  if (torque.offset != 0) json["offset"] = torque.offset;
  return json;
}

} // namespace wingspread
