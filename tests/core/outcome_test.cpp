// What is read from an outcome: the latch that holds a hinge, the methods' names, the reason with the hinges' names.
#include "core/outcome.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE("a hinge is held by its last latch if that has engaged more often than it let go") {
  Outcome out;
  CHECK(holding_latch(out, 0) == nullptr);
  out.latches = {{0, 1, {}}, {1, 2, {}}, {0, 5, {}}, {0, 9, {}}};
  const auto time_of = [&](int hinge) {
    const LatchEvent* latch = holding_latch(out, hinge);
    return latch ? latch->time : -1;
  };
  for (int lost = 0; lost <= 3; ++lost) {
    CAPTURE(lost);
    CHECK(time_of(0) == (lost < 3 ? 9 : -1));
    CHECK(time_of(1) == 2); // hinge 0 alone has let go
    CHECK(time_of(2) == -1);
    out.let_go.push_back({0, 3.0 + lost, 0});
  }
  out.let_go.push_back({1, 4, 0});
  CHECK(time_of(1) == -1);
}

TEST_CASE("each method of a run is named once, in order of its first phase") {
  Outcome out;
  CHECK(methods_used(out).empty());
  out.phases = {{"taylor", 0, 1, 10}, {"dop853", 1, 2, 5}, {"taylor", 2, 3, 5}};
  CHECK(methods_used(out) == "taylor, dop853");
}

TEST_CASE("the reason names every hinge that was never released, and which hold may yet let go") {
  Scene scene;
  for (const char* name : {"root", "mid", "tip"}) scene.hinges.emplace_back().name = name;
  Outcome out;
  out.reason = "energy";
  name_held_hinges(scene, out);
  CHECK(out.reason == "energy"); // no hinge is held
  out.never_released = {1, 2}, out.may_release_later = {2};
  name_held_hinges(scene, out);
  CHECK(out.reason == "mid was never released; tip was never released up to t_end; its hold may "
                      "let go later");
}

TEST_CASE("each status has its own word") {
  CHECK(to_string(Status::deployed) == std::string("deployed"));
  CHECK(to_string(Status::stalled) == std::string("stalled"));
  CHECK(to_string(Status::timed_out) == std::string("timed_out"));
  CHECK(to_string(Status::invalid) == std::string("invalid"));
  CHECK(to_string(Status::failed) == std::string("failed"));
}
