#include "montecarlo/model/scene_file/motor_json.hpp"

#include "montecarlo/model/scene_file/torque_json.hpp"

#include <memory>
#include <utility>

namespace wingspread {
namespace {

constexpr std::string_view expected_motor_table =
    "a table: an object with time and rate; a monotone cubic (PCHIP) between its points unless "
    "\"interpolation\" is \"linear\", constant beyond its ends";

bool read_columns(const JsonCursor& at, Motor& motor) {
  JsonObject object(at, expected_motor_table);
  const std::string expected = expected_column("s");
  const auto time = object.require("time", expected);
  const auto rate = object.require("rate", expected_column("rad/s"));
  object.refuse_others();
  if (!time || !rate || !time->read(motor.time, Dimension{"s"})) return false;
  if (!can_be_knots(motor.time.size())) return time->refuse(expected);
  return check_ascending(*time, motor.time, "time") &&
         read_column_beside(*rate, motor.time, "times", Dimension{"rad/s"}, motor.rates);
}

void read_table(const JsonCursor& at, Motor& motor) {
  JsonObject object(at, "a number, rad/s, or an object with a table of time and rate");
  const auto table = object.require("table", expected_motor_table);
  object.optional_choice("interpolation", motor.interpolation, interpolation_names);
  object.optional("scale", motor.scale, "a number");
  object.refuse_others();
  if (!table || !read_columns(*table, motor)) return;
  Curve curve(motor.time, motor.rates, motor.interpolation);
  if (is_finite(curve))
    motor.table = std::make_shared<const Curve>(std::move(curve));
  else
    table->refuse("a curve that overflows", "times further apart, or smaller rates");
}

} // namespace

void read_motor(const JsonCursor& at, std::optional<Motor>& motor) {
  JsonObject object(at, "an object with the motor's rate, gain and torque_limit");
  motor.emplace();
  if (const auto rate =
          object.require("rate", "a number, rad/s, or an object with a table of time and rate")) {
    if (rate->value().is_object())
      read_table(*rate, *motor);
    else
      rate->read(motor->rate, Dimension{"rad/s", "or an object with a table of time and rate"});
  }
  object.required("gain", motor->gain, Dimension{"N·m·s/rad", "≥ 0"});
  object.required("torque_limit", motor->torque_limit, Dimension{"N·m", "≥ 0"});
  object.refuse_others();
}

Json write_motor(const Motor& motor) {
  Json json{{"rate", motor.rate}, {"gain", motor.gain}, {"torque_limit", motor.torque_limit}};
  if (motor.table)
    json["rate"] = {
        {"table", {{"time", motor.time}, {"rate", motor.rates}}},
        {"interpolation", interpolation_names[static_cast<std::size_t>(motor.interpolation)]},
        {"scale", motor.scale}};
  return json;
}

} // namespace wingspread
