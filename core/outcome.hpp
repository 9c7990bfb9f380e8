/// Settings and results of a run, as plain data.
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
  /// Tolerances of a step, for every component of the state, both > 0: relative, and absolute (rad,
  /// rad/s, m, m/s). Divided by 32 up to the first latch: errors made there shift everything later.
  double rtol = 1e-8, atol = 1e-10;
  std::optional<double> smoothing; ///< ε of the smoothed latch, rad; none: event latch
  double t_end = 60;               ///< s, > 0
  long max_steps = 1'000'000;      ///< the run fails after so many trial steps
  double step = 1e-4;              ///< s, > 0; only for methods with a fixed step
};

/// The results asked of a run. The run ends as soon as these are final, unless to_t_end.
struct Goal {
  bool peak_moment = true;
  bool peak_force = true;
  bool overtravel = true;        ///< fill Outcome::overtravel
  bool hold_moment = true;       ///< fill Outcome::hold_moment
  bool base_motion = false;      ///< end only once the peaks of a free base's motion are final
  bool motor_energy = true;      ///< fill Outcome::motor_energy
  bool audit = true;             ///< fill EnergyAudit::drift_before_first_latch
  bool end_state = true;         ///< fill Outcome::final and Outcome::energy
  bool final_angle = true;       ///< fill Outcome::final_angle
  bool to_rest = false;          ///< end only once all hinges are stuck for good, or at t_end
  bool to_t_end = false;         ///< integrate to t_end whatever happens
  bool first_latch_only = false; ///< end at the first latch
  bool mode_frequencies = false; ///< fill Outcome::mode_frequencies
  /// The observer is called at multiples of this time, by dense output, s; 0: after every step.
  double sample_interval = 0;
  bool sample_motion_only = false; ///< samples without moments and energies
};

/// `deployed`: at the end every latch is engaged and no hinge is held. A hinge without a latch need not do more.
/// `stalled`: it is proven that no open latch will engage any more, though hinges may still swing; or a hinge, with a
/// latch or without, is still held at the end. Outcome::reason names the proof: everything sticks, energy is missing,
/// or a hinge was never released. `timed_out`: t_end came first. A scene without latches ends so, unless a hinge is
/// still held.
enum class Status { deployed, stalled, timed_out, invalid, failed };
[[nodiscard]] const char* to_string(Status status);

/// A hinge reached its latched angle.
struct LatchEvent {
  int hinge;                 ///< index into Scene::hinges
  double time;               ///< s
  std::vector<double> rates; ///< relative rates of all hinges at that instant, Scene order, rad/s
};

/// Another event of a hinge.
struct HingeEvent {
  int hinge = 0;   ///< index into Scene::hinges
  double time = 0; ///< s
  double rate = 0; ///< of the hinge at that instant, rad/s
};

/// The largest magnitude of a quantity, and the time when it was first reached, s.
struct Peak {
  double value = 0;
  double time = 0;
};

/// Positions and velocities of a scene; vectors in Scene order, SI units.
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
  double final = 0;   ///< the same at the end, J
  /// Largest |E(t) − E(0)| up to the first latch (or the end), J: an error of integration, unless there
  /// is friction or the base is driven
  double drift_before_first_latch = 0;
};

struct Work {
  long steps = 0; ///< accepted
  long rejected = 0;
  long rhs_evaluations = 0;
};

/// A time span that one method integrated.
struct Phase {
  std::string method;
  double from = 0, to = 0; ///< s
  long steps = 0;          ///< accepted
};

/// Which results no later motion can change, by proof at the run's end. Members as in Outcome.
struct Finality {
  bool peaks = false, moments = false, forces = false;
  bool latches = true;
};

/// All results of one run. Vectors over hinges are in Scene order. The segments and joints of flexible bodies are not
/// in it, but for bending_moment.
struct Outcome {
  Status status = Status::failed;
  std::string reason;              ///< why status is stalled, invalid or failed; else empty
  std::vector<Phase> phases;       ///< in order of time
  double t_end = 0;                ///< time at which the integration ended, s
  std::vector<LatchEvent> latches; ///< every engagement, in order of time
  std::vector<HingeEvent> let_go;  ///< engaged latches that let go, in order of time
  std::vector<HingeEvent>
      missed; ///< passes of the latched angle too fast for the latch, in order of time
  std::vector<HingeEvent> releases; ///< holds that let go, in order of time
  /// Hinges that are still held at the end of a stalled run, without those that wait for another held hinge.
  std::vector<int> never_released;
  std::vector<int> may_release_later; ///< held hinges whose hold may let go after t_end
  std::vector<Peak> peak_moment;      ///< N·m; empty when not asked for
  std::vector<Peak> peak_force;       ///< N; empty when not asked for
  /// The largest moment that each hinge's hold bore, N·m; empty when not asked for, or where no hinge is held.
  std::vector<Peak> hold_moment;
  std::vector<double>
      final_angle; ///< at t_end, from the latched angle, rad; empty when not asked for
  /// Work of each hinge's motor while the hinge's latch was not engaged, J; 0 without a motor. Empty when not asked
  /// for, or where no hinge has a motor.
  std::vector<double> motor_energy;
  /// The largest moment in the joints of each flexible body and in the hinges on its end segments, by Scene::bodies, N·m;
  /// empty when no moments are asked for, or without flexible bodies. Zero for a rigid body.
  std::vector<Peak> bending_moment;
  /// Natural frequencies of the scene with all latches engaged, even if the run did not deploy; lowest first, Hz. Empty
  /// if not asked for, or if the scene is unphysical or has no rest.
  std::vector<double> mode_frequencies;
  /// How far each hinge turned beyond its stowed angle up to t_end, rad, ≥ 0; empty when not asked for.
  std::vector<double> overtravel;
  /// Largest changes of the base's angle and rate up to t_end; nothing if the base is not free.
  std::optional<BasePeaks> base_peaks;
  /// Whether it is proven that no peak of moments and forces would rise after t_end. If false, peaks may still rise, or
  /// there is no proof. None exists if a hinge has neither an engaged latch nor a spring towards rest, and on a base that
  /// turns faster and faster none that holds for ever.
  bool peaks_final = false;
  /// The same of the moments alone, those in flexible bodies included, and of the forces alone; true where peaks_final
  /// is.
  bool moments_final = false, forces_final = false;
  /// False: the run deployed, and it is not proven that every latch with a holding_moment stays engaged after t_end.
  bool latches_final = true;
  Configuration final; ///< at t_end; empty unless Goal::end_state
  EnergyAudit energy;  ///< zeros unless Goal::end_state or audit
  Work work;
};

/// The engagement of the hinge that holds at the end of the run; null without one.
[[nodiscard]] const LatchEvent* holding_latch(const Outcome& outcome, int hinge);

/// Says in words which hinges were never released, of a run that stalled for that.
void name_held_hinges(const Scene& scene, Outcome& outcome);

/// The first hinge with a latch that may miss, let go or rattle; null without one. A smoothed latch does none of these:
/// such a run fails with the reason `needs_event_latches`.
[[nodiscard]] const Hinge* hinge_with_event_latch(const Scene& scene);
inline constexpr const char* needs_event_latches =
    "a latch with a capture rate, a holding moment or backlash needs event latches";

/// Names the methods of an outcome's phases, each once, in order of first use: "dopri5, rosenbrock_w".
[[nodiscard]] std::string methods_used(const Outcome& outcome);

/// One sample of a trajectory: the end of an accepted step or, with Goal::sample_interval, one of its
/// multiples. An event gives two samples, before and after.
struct Sample {
  double t = 0;
  std::vector<double> angles;          ///< relative, Scene order, rad
  std::vector<double> rates;           ///< rad/s
  std::vector<double> moments;         ///< N·m; zeros with Goal::sample_motion_only
  double kinetic = 0;                  ///< J; the same
  double potential = 0;                ///< J; the same
  Eigen::Vector2d base_position{0, 0}; ///< of a free base, m
  double base_angle = 0;               ///< rad
  double base_rate = 0;                ///< rad/s
};
using Observer = std::function<void(const Sample&)>;

} // namespace wingspread
