/// Timed runs of a wing, for the throughput study.
#pragma once

#include "core/deployment.hpp"
#include "studies/support/study.hpp"

#include <functional>
#include <vector>

namespace wingspread::study {

/// Processor time of this thread, s.
[[nodiscard]] double thread_seconds();
/// Wall time, s.
[[nodiscard]] double wall_seconds();

/// Dispersed copies (units) of a wing: springs ±5 %, masses and inertias ±2 %.
class Units {
public:
  explicit Units(Scene drawing) : drawing_(std::move(drawing)) {}

  /// Sets springs, masses and inertias of unit k. @pre all else in the scene equals the drawing
  void set(Scene& scene, long k) const;
  [[nodiscard]] const Scene& drawing() const { return drawing_; }

private:
  Scene drawing_;
};

/// End and outputs of the runs.
struct What {
  const char* name;
  Goal goal;
  double t_end = 60;
};
inline const What every_output{"all outputs", {.audit = false, .end_state = false}};
inline const What moments_too{"latches, peak moments",
                              {.peak_force = false, .audit = false, .end_state = false}};
inline const What latches_only{"to the last latch",
                               {.peak_moment = false,
                                .peak_force = false,
                                .overtravel = false,
                                .audit = false,
                                .end_state = false}};
inline const What first_latch{"A: to the first latch",
                              {.peak_moment = false,
                               .peak_force = false,
                               .overtravel = false,
                               .audit = false,
                               .end_state = false,
                               .first_latch_only = true}};
inline const What early_stop{"B: with the early stop", moments_too.goal};
inline const What whole_run{
    "B: whole run to 12 s",
    {.peak_force = false, .audit = false, .end_state = false, .to_t_end = true},
    seed_t_end};

[[nodiscard]] Integration within(double rtol, const What& what);

struct Made {
  double us = 0; ///< processor time of a run, µs, on one thread
  double steps = 0, evaluations = 0;
  Occupancy lanes;
  std::vector<Outcome> outcomes;
};

/// Sets the scene to that of run k. @pre the scene is the drawing, or the result of an earlier call
using SetScene = std::function<void(Scene&, long)>;

/// Makes the runs 0 … count − 1 several times and keeps the least time. Only the last repetition keeps the outcomes,
/// because a campaign, and the program it is compared with, drop each outcome once it is read.
[[nodiscard]] Made make(const Scene& drawing, const SetScene& set_scene, InstructionSet set,
                        const Integration& how, const Goal& goal, long count, int times = 3);
[[nodiscard]] Made make(const Units& units, InstructionSet set, const Integration& how,
                        const Goal& goal, long count, int times = 3);

} // namespace wingspread::study
