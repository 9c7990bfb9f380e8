/// What is asked of a run, and what comes of it: plain data that every room below the door may use.
#pragma once

#include "core/scene/scene.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace wingspread {

/// How a run is integrated.
struct Integration {
  std::string method = "auto"; ///< a name from `methods()`
  /// Tolerances per step of every component of the state, both > 0: relative, and absolute (rad,
  /// rad/s, m, m/s). Up to the first latch, where steps are few and errors carry on, 32 times
  /// tighter.
  double rtol = 1e-8, atol = 1e-10;
  std::optional<double> smoothing; ///< ε of the smoothed latch, rad; none: event latch
  double t_end = 60;               ///< s, > 0
  long max_steps = 1'000'000;      ///< tried steps after which the run fails
  double step = 1e-4;              ///< s, > 0; of a method with a fixed step, no other uses it
};

/// What is asked of a run: it computes no more, and goes no further than that needs.
struct Goal {
  bool peak_moment = true;
  bool peak_force = true;
  bool overtravel = true;        ///< watch how far hinges turn beyond their stowed angles
  bool audit = true;             ///< watch the energy up to the first latch
  bool end_state = true;         ///< tell the final configuration and the energies
  bool to_t_end = false;         ///< integrate to t_end whatever happens
  bool first_latch_only = false; ///< end at the first latch
  /// The observer is shown the multiples of it, by dense output, in place of every step; s, 0: every step.
  double sample_interval = 0;
};

/// `stalled`: a hinge has not latched, and there is proof that none will any more, though some may
/// swing on; the reason says which: everything sticks, or energy is missing. A scene without any
/// latch ends `timed_out`.
enum class Status { deployed, stalled, timed_out, invalid, failed };
[[nodiscard]] const char* to_string(Status status);

/// A hinge reached its latched angle.
struct LatchEvent {
  int hinge;                 ///< index into Scene::hinges
  double time;               ///< s
  std::vector<double> rates; ///< relative rates of all hinges at that instant, Scene order, rad/s
};

/// The largest magnitude that a quantity took, and when it first took it.
struct Peak {
  double value = 0;
  double time = 0;
};

/// The state of a scene, in Scene order.
struct Configuration {
  std::vector<double> angles; ///< relative, rad
  std::vector<double> rates;  ///< relative, rad/s
  Eigen::Vector2d base_position{0, 0};
  Eigen::Vector2d base_velocity{0, 0};
  double base_angle = 0;
  double base_rate = 0;
};

/// The largest change of a free base's motion since the start of a run.
struct BasePeaks {
  double angle = 0; ///< rad
  double rate = 0;  ///< rad/s
};

struct EnergyAudit {
  double initial = 0; ///< kinetic + potential, J
  double final = 0;
  /// Largest |E(t) − E(0)| up to the first latch (or the end): zero but for errors, unless there is
  /// friction or the base is driven, J
  double drift_before_first_latch = 0;
};

struct Work {
  long steps = 0; ///< accepted
  long rejected = 0;
  long rhs_evaluations = 0;
};

/// A stretch of a run that one method integrated.
struct Phase {
  std::string method;
  double from = 0, to = 0; ///< s
  long steps = 0;          ///< accepted
};

/// Everything one run yields. Vectors over hinges stand in Scene order.
struct Outcome {
  Status status = Status::failed;
  std::string reason;              ///< why it stalled, was invalid or failed; empty otherwise
  std::vector<Phase> phases;       ///< what integrated it, in order of time
  double t_end = 0;                ///< where the integration stopped, s
  std::vector<LatchEvent> latches; ///< in order of time
  std::vector<Peak> peak_moment;   ///< N·m; empty when not asked for
  std::vector<Peak> peak_force;    ///< N; empty when not asked for
  /// How far each hinge turned beyond its stowed angle up to the run's end, rad, ≥ 0; empty when it was not watched.
  /// It is final where peaks are, unless the run stalled.
  std::vector<double> overtravel;
  /// Up to the run's end, whatever it was that ended it; nothing where the base is not free.
  std::optional<BasePeaks> base_peaks;
  /// Whether it is proven that no peak of moments and forces would be exceeded were the run to go on. If not,
  /// `t_end` cut them: they may still rise, or there is no proof, on a base that turns faster and
  /// faster and where a hinge has neither a latch that holds it nor a spring towards a rest.
  bool peaks_final = false;
  Configuration final; ///< nothing, and zeros, where the end's state is not asked for
  EnergyAudit energy;  ///< zeros
  Work work;
};

/// The methods of an outcome's phases, each once, in order of first use: "dopri5, rosenbrock_w".
[[nodiscard]] std::string methods_used(const Outcome& outcome);

/// One sample of a trajectory: every accepted step, and both sides of an engagement; or a multiple of
/// Goal::sample_interval.
struct Sample {
  double t = 0;
  std::vector<double> angles;          ///< relative, Scene order, rad
  std::vector<double> rates;           ///< rad/s
  std::vector<double> moments;         ///< N·m
  double kinetic = 0;                  ///< J
  double potential = 0;                ///< J
  Eigen::Vector2d base_position{0, 0}; ///< of a free base, m
  double base_angle = 0;               ///< rad
  double base_rate = 0;                ///< rad/s
};
using Observer = std::function<void(const Sample&)>;

} // namespace wingspread
