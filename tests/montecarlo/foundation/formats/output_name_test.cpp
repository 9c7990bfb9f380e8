#include "montecarlo/foundation/formats/output_name.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE("output names say hinge, quantity and unit") {
  const auto check = [](const char* name, const char* hinge, const char* quantity,
                        const char* other, const char* unit) {
    const OutputName parsed = parse_output_name(name);
    INFO(name);
    CHECK(parsed.hinge == hinge);
    CHECK(parsed.quantity == quantity);
    CHECK(parsed.other == other);
    CHECK(parsed.unit == std::string(unit));
  };
  check("root.latch_time", "root", "latch_time", "", "s");
  check("left.root.latch_rate", "left.root", "latch_rate", "", "rad/s");
  check("root.peak_moment", "root", "peak_moment", "", "N·m");
  check("root.peak_force", "root", "peak_force", "", "N");
  check("root.overtravel", "root", "overtravel", "", "rad");
  check("root.rate_at.tip", "root", "rate_at", "tip", "rad/s");
  check("deployment_time", "", "deployment_time", "", "s");
  check("peak_moment", "", "peak_moment", "", "");
}
