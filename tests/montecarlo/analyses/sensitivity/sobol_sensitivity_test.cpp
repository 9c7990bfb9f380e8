#include "montecarlo/analyses/sensitivity/saltelli.hpp"
#include "montecarlo/analyses/sensitivity/sobol_sensitivity.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE("a Saltelli design counts its runs: made so far, and in all") {
  for (const std::size_t dispersions : {std::size_t{1}, std::size_t{3}})
    for (const long made : {0L, 7L, 50L}) {
      Results results(ResultNames{{}, {"y"}});
      for (long run = 0; run < made; ++run)
        results.append({run, Status::deployed, {}, {static_cast<double>(run % 7)}, "", ""});
      const SobolSensitivity all = sobol_sensitivity(
          results, std::vector<std::string>(dispersions, "x"), 10, "random", SobolBounds{});
      CAPTURE(dispersions, made);
      CHECK((all.rows == 10 && all.runs == made));
      CHECK(all.total == 10 * (static_cast<long>(dispersions) + 2)); // A, B and one AB for each
      CHECK(all.total == saltelli_runs(10, dispersions));
    }
}

TEST_CASE("a draw that does not vary in a design is named, and is not one without an effect") {
  Results results(ResultNames{{"k", "s", "t"}, {"y"}});
  for (long run = 0; run < 40; ++run) // A, B, and A with one column of B, row by row
    results.append({run,
                    Status::deployed,
                    {1, static_cast<double>(run % 7), static_cast<double>(run % 3)},
                    {static_cast<double>(run / 5)},
                    "",
                    ""});
  const SobolSensitivity all =
      sobol_sensitivity(results, {"k", "s", "t"}, 8, "random", {.resamples = 20});
  CHECK(all.unvaried == std::vector<std::string>{"k"});
  CHECK(all.idle() == std::vector<std::string>{"s", "t"});
}
