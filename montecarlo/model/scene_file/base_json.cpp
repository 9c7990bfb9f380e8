#include "montecarlo/model/scene_file/base_json.hpp"

#include "montecarlo/model/scene_file/hinge_json.hpp"
#include "montecarlo/model/scene_file/torque_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace wingspread {
namespace {

constexpr std::string_view expected_table =
    "a table: an object with time and acceleration, angular_acceleration or rate";

bool read_times(JsonObject& table, std::vector<double>& time) {
  const std::string expected = expected_column("s");
  const auto at = table.require("time", expected);
  if (!at || !at->read(time, Dimension{"s"})) return false;
  if (!can_be_knots(time.size())) return at->refuse(expected);
  return check_ascending(*at, time, "time");
}

/// Reads a column of pairs.
bool read_accelerations(const JsonCursor& at, std::size_t times,
                        std::vector<Eigen::Vector2d>& column) {
  if (!at.value().is_array() || at.value().size() != times)
    return at.refuse(fmt::format("an array of {} accelerations, as many as there are times: each "
                                 "an array of 2 numbers, m/s²",
                                 times));
  bool good = true;
  for (const JsonCursor& element : at.elements()) {
    column.emplace_back(0, 0);
    good = element.read(column.back(), Dimension{"m/s²"}) && good;
  }
  return good;
}

bool is_finite(const BaseTable& table) {
  const auto finite = [](double number) { return std::isfinite(number); };
  return std::ranges::all_of(table.pieces(), [&](const BaseTable::Piece& piece) {
    return std::ranges::all_of(piece.x, finite) && std::ranges::all_of(piece.y, finite) &&
           std::ranges::all_of(piece.turning, finite) && finite(piece.velocity.x()) &&
           finite(piece.velocity.y()) && finite(piece.rate) && finite(piece.angle);
  });
}

/// Refuses keys that the table gives too.
void refuse_beside(JsonObject& base, const BaseTable::Columns& columns) {
  const auto refuse = [&](const char* key, const char* given) {
    if (const auto at = base.find(key))
      at->refuse(fmt::format("no {} beside a table of {}", key, given));
  };
  if (!columns.acceleration.empty()) refuse("acceleration", "acceleration");
  if (!columns.angular_acceleration.empty()) refuse("angular_acceleration", "angular_acceleration");
  if (columns.rate.empty()) return;
  refuse("angular_acceleration", "rate"), refuse("rate", "rate");
}

bool read_columns(JsonObject& object, BaseTable::Columns& columns) {
  bool good = read_times(object, columns.time);
  const auto a = object.find("acceleration"), alpha = object.find("angular_acceleration"),
             rate = object.find("rate");
  if (!good) return false;
  if (a) good = read_accelerations(*a, columns.time.size(), columns.acceleration);
  if (alpha)
    good = read_column_beside(*alpha, columns.time, "times", Dimension{"rad/s²"},
                              columns.angular_acceleration) &&
           good;
  if (rate)
    good =
        read_column_beside(*rate, columns.time, "times", Dimension{"rad/s"}, columns.rate) && good;
  if (rate && alpha) good = rate->refuse("no rate beside angular_acceleration: it is its integral");
  return good;
}

void read_table(const JsonCursor& at, JsonObject& base_object, Interpolation interpolation,
                Base& base) {
  JsonObject object(at, expected_table);
  if (!at.value().is_object()) return;
  BaseTable::Columns columns;
  const bool good = read_columns(object, columns);
  object.optional("scale", base.table_scale, "a number");
  object.refuse_others();
  if (!good) return;
  if (columns.acceleration.empty() && columns.angular_acceleration.empty() && columns.rate.empty())
    return void(at.refuse(expected_table));
  refuse_beside(base_object, columns);
  BaseTable table(std::move(columns), interpolation);
  if (is_finite(table))
    base.table = std::make_shared<const BaseTable>(std::move(table));
  else
    at.refuse("a curve that overflows", "times further apart, or a smaller motion");
}

void read_prescribed(JsonObject& object, Base& base) {
  object.optional("acceleration", base.acceleration, Dimension{"m/s²"});
  object.optional("angular_acceleration", base.angular_acceleration, Dimension{"rad/s²"});
  const auto table = object.find("table");
  Interpolation interpolation = Interpolation::monotone;
  object.optional_choice("interpolation", interpolation, interpolation_names);
  if (table)
    read_table(*table, object, interpolation, base);
  else if (const auto at = object.find("interpolation"))
    at->refuse("no interpolation without a table");
}

Json write_table(const Base& base) {
  const BaseTable::Columns& columns = base.table->columns();
  Json json{{"time", columns.time}};
  for (const Eigen::Vector2d& a : columns.acceleration)
    json["acceleration"].push_back(write_vector(a));
  if (!columns.angular_acceleration.empty())
    json["angular_acceleration"] = columns.angular_acceleration;
  if (!columns.rate.empty()) json["rate"] = columns.rate;
  if (base.table_scale != 1) json["scale"] = base.table_scale;
  return json;
}

/// Writes the prescribed motion. The JSON of a base without a table must not change, so that such scenes keep their
/// hash.
void write_prescribed(const Base& base, Json& json) {
  const BaseTable* table = base.table.get();
  if (!table || !table->gives_acceleration())
    json["acceleration"] = write_vector(base.acceleration);
  if (!table || !table->gives_turning()) json["angular_acceleration"] = base.angular_acceleration;
  if (!table) return;
  json["table"] = write_table(base);
  json["interpolation"] = interpolation_names[static_cast<std::size_t>(table->interpolation())];
}

} // namespace

void read_base(const JsonCursor& at, Base& base) {
  JsonObject object(at, "an object with the base's motion");
  if (!object.required_choice("motion", base.motion, base_motion_names)) return;
  if (base.motion == BaseMotion::free) {
    object.required("mass", base.mass, Dimension{"kg", "> 0"});
    object.required("inertia", base.inertia, Dimension{"kg·m²", "> 0"});
    object.optional("position", base.position, Dimension{"m"});
    object.optional("velocity", base.velocity, Dimension{"m/s"});
  }
  if (base.motion == BaseMotion::prescribed) read_prescribed(object, base);
  if (base.motion != BaseMotion::fixed) {
    object.optional("angle", base.angle, Dimension{"rad"});
    object.optional("rate", base.rate, Dimension{"rad/s"});
  }
  object.refuse_others();
}

Json write_base(const Base& base) {
  Json json{{"motion", base_motion_names[static_cast<std::size_t>(base.motion)]}};
  if (base.motion == BaseMotion::fixed) return json;
  if (base.motion == BaseMotion::free) {
    json["mass"] = base.mass;
    json["inertia"] = base.inertia;
    json["position"] = write_vector(base.position);
    json["velocity"] = write_vector(base.velocity);
  } else {
    write_prescribed(base, json);
  }
  json["angle"] = base.angle;
  if (!base.table || !base.table->gives_rate()) json["rate"] = base.rate;
  return json;
}

} // namespace wingspread
