/// TESTS.json: the deployment tests to which parameters of a campaign are fitted.
///
///     { "tests": [ { "name": "air, 20 °C", "case": "ambient", "set": { PATH: value }, "scale": {…}, "add": {…},
///                    "trace": { "file": "t1.csv", "time": "t_s", "time_offset_std": "0.01 s", "correlated": true,
///                               "columns": { "root.angle": { "column": "th1", "unit": "deg", "std": "0.3 deg",
///                                                            "offset_std": "0.2 deg" } } },
///                    "values": [ { "output": "root.latch_time", "value": "4.93 s", "std": "0.02 s" },
///                                { "parameter": PATH, "value": 1.02, "std": 0.05 } ],
///                    "own": [ "friction.*" ] } ],
///       "fit": { "parameters": [ "spring", "friction.*" ], "starts": 8, "samples": 10000 },
///       "candidates": [ as a test, with "times": { "to", "step" } in place of a file, and values without "value" ] }
///
/// A test changes the nominal scene like a case, before the parameters. Dispersions that are not fitted keep their
/// medians in a test.
#pragma once

#include "montecarlo/model/campaign/campaign.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace wingspread {

/// One column of a trace beside the same column of the trajectory.
struct FitColumn {
  std::string name;          ///< of the trajectory: "root.angle"
  std::size_t index = 0;     ///< among trajectory_columns()
  std::string_view unit{};   ///< SI
  std::optional<double> std; ///< of the noise; nothing: unknown, with the prior 1/σ
  double offset_std = 0;     ///< of a constant offset of this column; 0: none
  /// SI, one for each of FitTest::times; zeros in a candidate.
  std::vector<double> measured;
};

/// A number measured in a test: an output of the run, or a parameter of the scene (a torque test).
struct FitValue {
  std::string name;                        ///< the output, or the parameter's path
  std::string unit;                        ///< SI
  std::optional<SceneParameter> parameter; ///< nothing: an output
  double measured = 0, std = 0;
};

struct FitTest {
  std::string name;
  Campaign campaign; ///< with the test's case, changes and outputs; without cases
  /// Of the trace, on its own clock, s.
  std::vector<double> times;
  double interval = 0;        ///< between the samples of a run, s; 0: grid_interval of the times
  double interpolation = 0;   ///< what interpolation adds to χ²: choose_intervals, test_runs.hpp
  double time_offset_std = 0; ///< of the clock, s; 0: no offset
  bool correlated =
      true; ///< temper the likelihood of a trace by the autocorrelation of its residuals
  std::vector<FitColumn> columns;
  std::vector<FitValue> values;
  std::vector<std::size_t> own; ///< dispersions with a value of their own in this test
};

struct FitSpec {
  std::vector<std::size_t> parameters; ///< indices of the campaign's dispersions, ascending
  int starts = 8;
  long samples = 10000; ///< effective sample size to reach
  std::vector<FitTest> tests;
  std::vector<FitTest> candidates; ///< measured values are zeros
  Json resolved; ///< the document; with the traces' bytes hashed, it identifies the study
};

/// @throws SpecError with all problems
[[nodiscard]] FitSpec read_fit_file(const std::filesystem::path& path, const Campaign& campaign);
/// @param directory base of the file names
[[nodiscard]] FitSpec read_fit(const Json& document, const std::string& file,
                               const std::filesystem::path& directory, const Campaign& campaign);

} // namespace wingspread
