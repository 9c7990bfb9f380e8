/// A whole deployment: from a scene to its outcome. Knows no files, JSON or threads.
#pragma once

#include "core/outcome.hpp"
#include "core/packs/instruction_set.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace wingspread {

/// An integration method that can be named in a campaign.
struct MethodInfo {
  std::string name;
  std::string kind;  ///< e.g. "explicit Runge-Kutta, adaptive"
  int order;         ///< of the solution that is carried on; 0 where it chooses
  double real_limit; ///< largest stable |hλ| on the negative real axis; 0 where there is none, or
                     ///< none for all its orders
  double imaginary_limit;    ///< the same on the imaginary axis
  std::string interpolation; ///< how events and peaks are found inside a step
  std::string note;
};
[[nodiscard]] const std::vector<MethodInfo>& methods();

/// Runs scenes one after another, keeping what the next can use of the last. Not shared by threads:
/// each has its own.
class Deployment {
public:
  Deployment();
  ~Deployment();
  Deployment(Deployment&&) noexcept;
  Deployment& operator=(Deployment&&) noexcept;

  /// Integrates a deployment. Never throws for what the numbers do: an unphysical scene comes back
  /// `invalid`, an integration that cannot go on `failed`, each with its reason.
  /// @pre outward_order(scene) is not empty; integration.method is one of methods(); rtol, atol,
  /// t_end and a given smoothing are > 0.
  [[nodiscard]] Outcome run(const Scene& scene, const Integration& integration, const Goal& goal,
                            const Observer& observer = {});

private:
  struct Kept;
  std::unique_ptr<Kept> kept_;
};

/// Runs many scenes, several at once in the lanes of vector registers. Each outcome has the bits
/// that Deployment::run gives. Not shared by threads: each has its own.
class DeploymentPack {
public:
  /// next(scene) sets a scene to that of the run that comes next and returns its name; none when
  /// there are no more. All have the bodies and hinges of the first.
  using Next = std::function<std::optional<long>(Scene&)>;
  /// done(name, outcome), in the order in which the runs end.
  using Done = std::function<void(long, Outcome&&)>;

  DeploymentPack(InstructionSet set, const Integration& integration, const Goal& goal);

  /// @pre as of Deployment::run, for every scene; scene: the structure
  Occupancy run(Scene scene, const Next& next, const Done& done);

private:
  InstructionSet set_;
  Integration how_;
  Goal goal_;
};

} // namespace wingspread
