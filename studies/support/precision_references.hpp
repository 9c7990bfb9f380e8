/// The reference runs of the work-precision study, kept in a file because they take seconds to
/// minutes each.
#pragma once

#include "core/scene/scene.hpp"
#include "studies/support/precision_figures.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace wingspread::study {

/// Where a reference comes from: tests/support's dense formulation in absolute angles, integrated
/// by Fehlberg's order 8 in 64 or 113 bits with real steps to every event and peak; or by CVODE
/// in double, with its own root finding and interpolant: Adams, or for exact friction BDF with the
/// friction regularized over 1e-6 rad/s, of which it is the limit.
enum class Source { extended, quad, cvode, regularized };
[[nodiscard]] const char* to_string(Source source);

/// How a reference is made.
struct ReferenceSettings {
  Source source = Source::extended;
  double rtol = 1e-17, atol = 1e-18; ///< per step, of every component; rad, rad/s
  std::optional<double> smoothing;   ///< ε of the smoothed latch, rad and s; none: event latch
  double t_end = 12;                 ///< s
};

/// One reference as the file holds it.
struct ReferenceRow {
  std::string key; ///< of the scene's parameters and the settings
  int scene = 0;   ///< number of the campaign's run
  ReferenceSettings settings;
  double seconds = 0; ///< it took
  Figures figures;
};

/// The largest relative differences between two references of one scene.
struct Disagreement {
  bool same_order = false; ///< else there are no differences to tell
  double time = 0, rate = 0, moment = 0, force = 0;
};
[[nodiscard]] Disagreement disagreement(const Figures& a, const Figures& b);

/// Makes references, or takes them from the file when they are there. Not for several processes on
/// one file.
class ReferenceStore {
public:
  /// @param hinges names, in Scene order: they head the columns
  /// A file with other columns is not read, and replaced.
  ReferenceStore(std::filesystem::path file, std::vector<std::string> hinges);

  /// Blocks for as long as the run takes when it is not in the file, then writes the file.
  [[nodiscard]] ReferenceRow get(const Scene& scene, int number, const ReferenceSettings& settings);

  /// Writes all references: those asked for, each with its disagreement with the first asked for of
  /// its scene and latch, then what else the file held.
  void write() const;

private:
  [[nodiscard]] std::string header() const;
  void read();
  void append(std::string& text, const ReferenceRow& row, const ReferenceRow* primary) const;
  /// @return nullptr for the primary itself
  [[nodiscard]] const ReferenceRow* primary_of(const ReferenceRow& row) const;

  std::filesystem::path file_;
  std::vector<std::string> hinges_;
  std::vector<ReferenceRow> cached_; ///< read, not asked for yet
  std::vector<ReferenceRow> rows_;   ///< asked for
};

} // namespace wingspread::study
