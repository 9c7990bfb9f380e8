// One deployment as drawn, then a thousand dispersed ones: when each hinge latches, and what the root must carry.
#include <wingspread/wingspread.hpp>

#include <algorithm>
#include <cstdio>

int main() {
  namespace ws = wingspread::api;
  const ws::Outcome drawn = ws::simulate(ws::from_file("studies/scenes/three_panel_flight.json"));
  for (const ws::Latch& latch : drawn.latches)
    std::printf("%s latches at %.3f s with %.3f rad/s\n", latch.hinge.c_str(), latch.time,
                latch.rate);

  const ws::Table runs = ws::run(ws::from_file("studies/campaigns/seed.json"), {.runs = 1000});
  const auto moments = runs.numbers("root.peak_moment");
  std::printf("peak moment at the root: %.1f N·m as drawn, up to %.1f N·m in %zu runs\n",
              drawn.peak_moment[0].value, *std::max_element(moments.begin(), moments.end()),
              runs.size());
}
