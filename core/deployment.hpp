/// The door of core: integrates deployments, from a scene to its outcome. Knows no files, JSON or
/// threads. `Deployment` makes runs one by one, `DeploymentPack` many at once.
#pragma once

#include "core/outcome.hpp"
#include "core/packs/instruction_set.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace wingspread {

/// Describes an integration method, for tables and --help.
struct MethodInfo {
  std::string name; ///< for Integration::method
  std::string kind; ///< e.g. "explicit Runge-Kutta, adaptive"
  int order;        ///< of the solution; 0: varies
  double
      real_limit; ///< largest stable |hλ| on the negative real axis; infinity: no limit; 0: unstable,
                  ///< or varies with the order
  double imaginary_limit;    ///< the same on the imaginary axis
  std::string interpolation; ///< how events and peaks inside a step are found
  std::string note;
};
/// All methods that a campaign may name, `auto` first.
[[nodiscard]] const std::vector<MethodInfo>& methods();

/// Integrates scenes one after another, and reuses storage while their trees are equal. One object a
/// thread.
class Deployment {
public:
  Deployment();
  ~Deployment();
  Deployment(Deployment&&) noexcept;
  Deployment& operator=(Deployment&&) noexcept;

  /// Integrates one deployment. Numbers never make it throw: status `invalid` says that the scene is
  /// unphysical, `failed` that the integration cannot go on, both with a reason.
  /// @param observer is called with samples of the trajectory, if given
  /// @pre outward_order(scene) is not empty; integration.method is a name from methods(); rtol, atol,
  ///      t_end, step and a given smoothing are > 0
  [[nodiscard]] Outcome run(const Scene& scene, const Integration& integration, const Goal& goal,
                            const Observer& observer = {});

private:
  struct Kept;
  std::unique_ptr<Kept> kept_;
};

/// Integrates many scenes, several at once in the lanes of vector registers. Each outcome has the same
/// bits as from Deployment::run. One object a thread.
class DeploymentPack {
public:
  /// next(scene) changes the scene to that of the next run and returns the run's name, any number;
  /// nothing when there are no more. Bodies and hinges must stay those of the first scene.
  using Next = std::function<std::optional<long>(Scene&)>;
  /// done(name, outcome) is called once for each run, in the order in which the runs end.
  using Done = std::function<void(long, Outcome&&)>;
  /// watch(name, sample) is called with the samples of each run in order, those of different runs in turn. The samples
  /// are those that an observer of Deployment::run gets.
  using Watch = std::function<void(long, const Sample&)>;

  /// @param set one of instruction_sets(); scalar: one run after another
  DeploymentPack(InstructionSet set, const Integration& integration, const Goal& goal);

  /// Makes all runs that `next` gives. @return how well the lanes were used
  /// @param scene any scene of this structure; `next` changes a copy
  /// @pre for every scene the preconditions of Deployment::run
  Occupancy run(Scene scene, const Next& next, const Done& done, const Watch& watch = {});

private:
  /// The same, with the frequencies of each scene's modes.
  Occupancy run_with_modes(const Scene& scene, const Next& next, const Done& done,
                           const Watch& watch);
  /// The same, of a scene with flexible bodies.
  Occupancy run_segmented(Scene scene, const Next& next, const Done& done, const Watch& watch);

  InstructionSet set_;
  Integration how_;
  Goal goal_;
};

} // namespace wingspread
