// Uses the installed library as somebody else's program does: prints one deployment, the rows of a campaign, the same
// scene as a function of a parameter, and what is wrong with a broken one. consumer_test.py compares it with the program.
#include <wingspread/wingspread.hpp>

#include <cstdio>

namespace ws = wingspread::api;

int main(int, char** argv) {
  const ws::Input scene = ws::from_file(argv[1]), campaign = ws::from_file(argv[2]);
  const ws::Outcome outcome = ws::simulate(scene, {}, 0.0);
  std::printf("%s", outcome.json.c_str());

  const ws::Table table = ws::run(campaign, {.runs = 64, .seed = 7, .threads = 2});
  const ws::Words orders = table.words("latch_order");
  std::printf("run,deployment_time,latch_order\n");
  for (std::size_t i = 0; i < table.size(); ++i)
    std::printf("%ld,%.17g,%s\n", table.runs()[i], table.numbers("deployment_time")[i],
                orders.texts[orders.codes[i]].c_str());

  const ws::Model model(scene, {"hinges.*.spring.scale"}, {"deployment_time"});
  const double x[] = {1.0, 1.5};
  double y[2];
  const bool all = model.evaluate(x, y);
  std::printf("%d %.17g %d\n", all, y[0], y[1] < y[0]);
  std::printf("%zu %s\n", outcome.trajectory.front().values.size(), ws::version().c_str());

  try {
    (void)ws::simulate(ws::from_text("{\"bodies\": 3}"));
  } catch (const wingspread::SpecError& error) {
    std::printf("%zu problems: %s\n", error.problems().size(),
                error.problems()[0].expected.c_str());
  }
}
