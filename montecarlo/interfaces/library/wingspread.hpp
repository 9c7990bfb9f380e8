/// The C++ library: simulates one deployment, runs campaigns and reads results folders.
///
///     #include <wingspread/wingspread.hpp>
///     namespace ws = wingspread::api;
///
///     const ws::Outcome nominal = ws::simulate(ws::from_file("three_panel.json"));
///     const ws::Table runs = ws::run(ws::from_file("campaign.json"), {.runs = 2000});
///     for (double moment : runs.numbers("root.peak_moment")) …
///     const ws::Fit fit = ws::fit(ws::from_file("campaign.json"), ws::from_file("tests.json"));
///
/// All numbers are in SI units and radians. The same seed gives the same bits as the program, with any number of
/// threads. Errors: wingspread::SpecError for wrong input, wingspread::MachineError if the machine lacks memory, disk
/// space or a permission, both with the text that the program prints; wingspread::Stopped after a stop. A run that fails
/// is a row of the table, not an error. Every function may be called from any thread, from several threads at once, and
/// in a process that was forked; each call has a thread pool of its own. A call computes with rounding to nearest and
/// without traps, whatever floating-point environment its thread has; on return the thread has its own again.
#pragma once

#include "montecarlo/foundation/formats/machine_error.hpp"
#include "montecarlo/foundation/formats/spec_error.hpp"
#include "montecarlo/foundation/platform/stopped.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread::api {

/// A scene or a campaign in JSON. The function that takes an Input reads the JSON, and throws if it is wrong.
struct Input {
  std::filesystem::path file; ///< empty: use the text
  std::string text;
  std::filesystem::path directory; ///< files named in the text are relative to it
};
/// @throws SpecError for an empty path and one with a NUL
[[nodiscard]] Input from_file(std::filesystem::path file);
[[nodiscard]] Input from_text(std::string json, std::filesystem::path directory = {});

/// Replacements for settings of the input: the options of `wingspread simulate`.
struct Settings {
  std::vector<std::string> set{}; ///< "PATH=VALUE": changes of the nominal scene
  std::string of_case{};          ///< the case; empty: the campaign's wing without any of its cases
  std::optional<std::string> method{}, latch{};          ///< latch: "event" or "smoothed:EPS"
  std::optional<double> step{}, rtol{}, atol{}, t_end{}; ///< s; 1; rad and rad/s; s
  std::optional<std::int64_t> max_steps{}; ///< the run fails after so many trial steps
};

/// One latching of a hinge.
struct Latch {
  std::string hinge;
  double time = 0;           ///< s
  double rate = 0;           ///< of this hinge at that time, rad/s
  std::vector<double> rates; ///< of all hinges at that time, in the scene's order, rad/s
};

/// A maximum over time.
struct Peak {
  double value = 0; ///< N·m or N
  double time = 0;  ///< s
};

/// A named column of numbers.
struct Series {
  std::string name;
  std::vector<double> values;
};

/// One deployment. Vectors over hinges are in the scene's order; they are empty if the run did not compute them.
struct Outcome {
  std::string status; ///< "deployed", "stalled", "timed_out", "invalid" or "failed"
  std::string reason; ///< why the wing did not deploy; may be empty
  double t_end = 0;   ///< time at which the integration stopped, s
  std::vector<std::string> hinges;
  std::vector<Latch> latches; ///< in order of time
  std::vector<Peak> peak_moment, peak_force;
  std::vector<double> angles, rates; ///< at the end, rad and rad/s
  std::string json; ///< the whole outcome, as `wingspread simulate --json` prints it
  /// The columns of `wingspread simulate --out`, `t` first; empty without an interval.
  std::vector<Series> trajectory;
  std::vector<std::string>
      notices; ///< the warnings of the input checks, as `wingspread simulate` prints them
};

/// Simulates one deployment of a scene, or of a campaign's nominal scene, to its t_end.
/// @param interval between rows of the trajectory, s, at most 10⁸ of them; 0: a row at every step; none: no trajectory
/// @param check repeats the run by another method at a tighter tolerance: `check` in the outcome's JSON
/// @param stop once true, the run ends at its next row
/// @throws SpecError, MachineError; Stopped after a stop
[[nodiscard]] Outcome simulate(const Input& input, const Settings& settings = {},
                               std::optional<double> interval = {}, bool check = false,
                               const std::atomic<bool>* stop = nullptr);

/// Replacements for settings of the campaign: the options of `wingspread run`.
struct RunOptions {
  std::optional<std::int64_t> runs{};
  std::optional<std::uint64_t> seed{};
  int threads = 0;                         ///< 0: OMP_NUM_THREADS, or all processors
  std::string of_case{};                   ///< the case; required for a campaign with cases
  std::vector<std::string> set{};          ///< "PATH=VALUE"
  const std::atomic<bool>* stop = nullptr; ///< once true, no further run begins
};

/// A column of repeated texts: row i has texts[codes[i]].
struct Words {
  std::span<const std::string> texts;
  std::span<const std::uint32_t> codes;
};

/// The rows of a campaign by columns, as in runs.csv. Spans stay valid as long as the table or a copy of it exists;
/// copies share the columns. Long columns are mapped from temporary files, so 10⁸ runs need no memory.
class Table {
public:
  /// How many rows.
  [[nodiscard]] std::size_t size() const;
  /// The names of all columns, in the order of runs.csv: `run`, `status`, draws, outputs, `peaks_final`, `latch_order`,
  /// `reason`.
  [[nodiscard]] std::vector<std::string> columns() const;
  /// The names of the columns of draws, and of outputs.
  [[nodiscard]] std::vector<std::string> draws() const;
  [[nodiscard]] std::vector<std::string> outputs() const;

  /// The numbers of the runs, from 0.
  [[nodiscard]] std::span<const long> runs() const;
  /// The values of a draw or an output; NaN for a missing value.
  /// @throws SpecError when no such column has numbers
  [[nodiscard]] std::span<const double> numbers(std::string_view column) const;
  /// The texts of `status`, `latch_order` or `peaks_final` ("true", "false", "", or the only family of peaks that is
  /// proven: "peak_moment" or "peak_force").
  /// @throws SpecError for any other column
  [[nodiscard]] Words words(std::string_view column) const;
  /// Why the wing did not deploy in this run; empty if it did. @pre row < size()
  [[nodiscard]] std::string reason(std::size_t row) const;

  /// Whether the table has all runs of the campaign, or of its shard; false after a stop, or for a folder that is not
  /// finished.
  [[nodiscard]] bool is_complete() const;
  /// The campaign with all defaults, as JSON.
  [[nodiscard]] const std::string& campaign() const;
  /// The warnings of the input checks, as `wingspread run` prints them; of a folder that was read, that it is a preview.
  [[nodiscard]] const std::vector<std::string>& notices() const;

  struct Data;
  explicit Table(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

private:
  std::shared_ptr<const Data> data_;
};

/// Makes a campaign's runs in memory; writes no files.
/// @throws SpecError, MachineError
[[nodiscard]] Table run(const Input& campaign, const RunOptions& options = {});

/// Reads the rows of a results folder.
/// @param of_case the case, for a campaign with cases
/// @throws SpecError, MachineError
[[nodiscard]] Table read(const std::filesystem::path& folder, const std::string& of_case = {});

/// The options of `wingspread fit`.
struct FitRequest {
  std::filesystem::path out{}; ///< the folder to write, new or empty; empty: writes no files
  std::optional<std::uint64_t> seed{};
  long runs = 0;                           ///< most runs of the sampler; 0: 400 for each sample
  int threads = 0;                         ///< 0: OMP_NUM_THREADS, or all processors
  const std::atomic<bool>* stop = nullptr; ///< once true, no further run begins
  bool resume = false; ///< goes on with the chains that an earlier call left in `out`
};

/// The fit of a campaign's parameters to deployment tests.
struct Fit {
  std::string json; ///< fit.json; `prediction` and `predicted_deployed` only with a folder
  std::vector<Series> posterior; ///< posterior.csv, by parameter
  bool finished = false;         ///< false: the chains are too short, and the numbers are no result
  std::vector<std::string> notices{}; ///< what is odd about the campaign
};

/// Fits parameters to tests.
/// @param tests the tests' JSON; files named in it are relative to its directory
/// @throws SpecError, MachineError; Stopped after a stop
[[nodiscard]] Fit fit(const Input& campaign, const Input& tests, const FitRequest& request = {});

/// A wing as a function y(x) of some of its parameters: for optimisers, designs of experiments and surrogates.
class Model {
public:
  /// @param paths   the components of x: parameters as dispersions name them; "hinges.*.spring.scale" sets several
  /// @param outputs the components of y: columns of runs.csv; empty: all except
  ///   `rate_at`, `base_motion`, `frequency` and `final_angle`
  /// @throws SpecError, MachineError
  Model(const Input& input, const std::vector<std::string>& paths,
        std::vector<std::string> outputs = {}, const Settings& settings = {});

  /// The number of components of x.
  [[nodiscard]] std::size_t parameters() const;
  /// The names of the components of y.
  [[nodiscard]] const std::vector<std::string>& outputs() const;
  /// The warnings of the input checks on the nominal wing.
  [[nodiscard]] const std::vector<std::string>& notices() const;
  /// The nominal x, SI; NaN for a path with several parameters of different values: no x stands for the nominal wing.
  [[nodiscard]] const std::vector<double>& nominal() const;

  /// Simulates n deployments, several at once in the lanes of each thread's vector registers. A row of y depends on
  /// its row of x alone.
  /// @param x n rows of parameters, row by row, SI
  /// @param y n rows of outputs, which are set; NaN for a missing value, or if the parameters are unphysical
  /// @param threads 0: OMP_NUM_THREADS, or all processors
  /// @return false if `stop` ended the call before the last row
  /// @throws SpecError unless x.size() == n · parameters() and y.size() == n · outputs().size(), and for a wrong number of
  ///   threads
  bool evaluate(std::span<const double> x, std::span<double> y, int threads = 0,
                const std::atomic<bool>* stop = nullptr) const;

private:
  struct Prepared;
  std::shared_ptr<const Prepared> prepared_;
};

/// The library's version, "0.2.0"; of a build between releases with its commit, "0.2.0+g998554094aca".
[[nodiscard]] std::string version();

} // namespace wingspread::api
