/// wingspread as a library: what `wingspread simulate`, `run` and a results folder give, as plain data.
///
///     #include <wingspread/wingspread.hpp>
///     namespace ws = wingspread::api;
///
///     const ws::Outcome nominal = ws::simulate(ws::from_file("three_panel.json"));
///     const ws::Table runs = ws::run(ws::from_file("campaign.json"), {.runs = 2000});
///     for (double torque : runs.numbers("root.peak_moment")) …
///
/// SI units and radians throughout. The same seed gives the same bits as the program does, whatever the number of
/// threads. What is wrong with an input is a wingspread::SpecError, what the machine refuses a
/// wingspread::MachineError, both with the texts that the program prints; a run that cannot go on is a row. Every
/// function may be called from any thread, and from several at once; each call has a team of threads of its own.
#pragma once

#include "montecarlo/foundation/formats/machine_error.hpp"
#include "montecarlo/foundation/formats/spec_error.hpp"

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

/// A scene or a campaign as it is written. It is read, and refused, where it is used.
struct Input {
  std::filesystem::path file; ///< its name, or empty where there is only the text
  std::string text;
  std::filesystem::path directory; ///< that the files named in the text are relative to
};
[[nodiscard]] Input from_file(std::filesystem::path file);
[[nodiscard]] Input from_text(std::string json, std::filesystem::path directory = {});

/// What is asked of one deployment in place of what the input says: the options of `wingspread simulate`.
struct Settings {
  std::vector<std::string> set{};               ///< "PATH=VALUE", changes of the nominal scene
  std::string of_case{};                        ///< of a campaign that has cases
  std::optional<std::string> method{}, latch{}; ///< latch: "event" or "smoothed:EPS"
  std::optional<double> step{}, rtol{}, atol{}, t_end{}; ///< s; 1; rad and rad/s; s
};

/// A hinge latched.
struct Latch {
  std::string hinge;
  double time = 0;           ///< s
  double rate = 0;           ///< the hinge's own, rad/s
  std::vector<double> rates; ///< of all hinges then, in the scene's order, rad/s
};

struct Peak {
  double value = 0; ///< N·m or N
  double time = 0;  ///< s
};

/// A named column of numbers.
struct Series {
  std::string name;
  std::vector<double> values;
};

/// One deployment in full. Vectors over hinges are in the scene's order; they are empty where nothing is known.
struct Outcome {
  std::string status; ///< "deployed", "stalled", "timed_out", "invalid" or "failed"
  std::string reason; ///< why it is not deployed; may be empty
  double t_end = 0;   ///< where the integration stopped, s
  std::vector<std::string> hinges;
  std::vector<Latch> latches; ///< in order of time
  std::vector<Peak> peak_moment, peak_force;
  std::vector<double> angles, rates; ///< at the end, rad and rad/s
  std::string json;                  ///< all of it, as `wingspread simulate --json` prints it
  /// Where it was asked for: the columns of `wingspread simulate --out`, `t` first.
  std::vector<Series> trajectory;
};

/// Integrates one deployment, of a scene or of a campaign's nominal scene, to its t_end.
/// @param interval of the trajectory's times, s; 0: every step; none: no trajectory
/// @throws SpecError, MachineError
[[nodiscard]] Outcome simulate(const Input& input, const Settings& settings = {},
                               std::optional<double> interval = {});

/// What is asked of a campaign in place of what it says: the options of `wingspread run`.
struct RunOptions {
  std::optional<std::int64_t> runs{};
  std::optional<std::uint64_t> seed{};
  int threads = 0; ///< 0: all processors
  std::string of_case{};
  std::vector<std::string> set{};          ///< "PATH=VALUE"
  const std::atomic<bool>* stop = nullptr; ///< once true no further run is begun
};

/// Texts that come again and again: row i has texts[codes[i]].
struct Words {
  std::span<const std::string> texts;
  std::span<const std::uint32_t> codes;
};

/// The rows of a campaign, by columns: those of runs.csv. What it hands out lives as long as it does, or any copy of it:
/// copies share the columns. Long columns lie in temporary files, mapped: 10⁸ runs need no memory.
class Table {
public:
  [[nodiscard]] std::size_t size() const;
  /// All columns as runs.csv has them: `run`, `status`, draws, outputs, `peaks_final`, `latch_order`, `reason`.
  [[nodiscard]] std::vector<std::string> columns() const;
  [[nodiscard]] std::vector<std::string> draws() const;
  [[nodiscard]] std::vector<std::string> outputs() const;

  /// The runs' numbers, counted from 0.
  [[nodiscard]] std::span<const long> runs() const;
  /// A draw or an output; NaN where it did not happen. @throws SpecError when there is no such column of numbers
  [[nodiscard]] std::span<const double> numbers(std::string_view column) const;
  /// `status`, `latch_order` or `peaks_final` ("true", "false" or ""). @throws SpecError when it is none of them
  [[nodiscard]] Words words(std::string_view column) const;
  /// Why a run is not `deployed`; empty otherwise. @pre row < size()
  [[nodiscard]] std::string reason(std::size_t row) const;

  /// Whether these are all runs that there will be; not so when it was stopped, or of a folder that is not finished.
  [[nodiscard]] bool is_complete() const;
  /// The campaign in full, as JSON.
  [[nodiscard]] const std::string& campaign() const;
  /// What looks wrong in it, though it can be run: what `wingspread run` warns of.
  [[nodiscard]] const std::vector<std::string>& notices() const;

  struct Data;
  explicit Table(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

private:
  std::shared_ptr<const Data> data_;
};

/// Makes a campaign's runs. Nothing is written.
/// @throws SpecError, MachineError
[[nodiscard]] Table run(const Input& campaign, const RunOptions& options = {});

/// The rows of a results folder. @param of_case of a campaign that has cases
/// @throws SpecError, MachineError
[[nodiscard]] Table read(const std::filesystem::path& folder, const std::string& of_case = {});

/// A wing as a function of some of its parameters: for optimisers, designs of experiments and surrogates.
class Model {
public:
  /// @param paths   of parameters as dispersions name them, each of one or several: "hinges.*.spring.scale"
  /// @param outputs columns of runs.csv, "root.latch_time"; none: all but the families `rate_at` and `base_motion`
  /// @throws SpecError, MachineError
  Model(const Input& input, const std::vector<std::string>& paths,
        std::vector<std::string> outputs = {}, const Settings& settings = {});

  [[nodiscard]] std::size_t parameters() const;
  [[nodiscard]] const std::vector<std::string>& outputs() const;
  /// The parameters' nominal values, SI; of a path that names several the first one's.
  [[nodiscard]] const std::vector<double>& nominal() const;

  /// Makes n deployments, several at once in the lanes of each thread's vector registers. Pure: a row depends on its
  /// own parameters alone.
  /// @param x n rows of parameters, one after the other, SI: they are set
  /// @param y n rows of outputs; NaN where it did not happen, or the parameters are unphysical
  /// @pre x.size() / parameters() == y.size() / outputs().size(), without a rest
  /// @return false when it was stopped before all were made
  bool evaluate(std::span<const double> x, std::span<double> y, int threads = 0,
                const std::atomic<bool>* stop = nullptr) const;

private:
  struct Prepared;
  std::shared_ptr<const Prepared> prepared_;
};

/// "0.1.0".
[[nodiscard]] std::string version();

} // namespace wingspread::api
