/// The reference runs of the work-precision study. A file keeps them, because each takes seconds to minutes.
#pragma once

#include "core/scene/scene.hpp"
#include "studies/support/precision_figures.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace wingspread::study {

/// The source of a reference. All use the dense formulation in absolute angles of tests/support.
///
/// extended, quad   Fehlberg's order 8 in 64 or 113 bits, with real steps to every event and peak
/// cvode            CVODE in double by Adams, with its own root finding and interpolant
/// regularized      CVODE by BDF, for exact friction: approximates it by friction regularized over 1e-6 rad/s
enum class Source { extended, quad, cvode, regularized };
[[nodiscard]] const char* to_string(Source source);

/// How a reference is made.
struct ReferenceSettings {
  Source source = Source::extended;
  double rtol = 1e-17, atol = 1e-18; ///< per step, of every component; rad, rad/s
  std::optional<double> smoothing;   ///< ε of the smoothed latch, rad and s; none: event latch
  double t_end = 12;                 ///< s
};

/// One reference, as in the file.
struct ReferenceRow {
  std::string key; ///< of the scene's parameters and the settings
  int scene = 0;   ///< number of the campaign's run
  ReferenceSettings settings;
  double seconds = 0; ///< wall time of the run
  Figures figures;
};

/// The largest relative differences between two references of one scene.
struct Disagreement {
  bool same_order = false; ///< whether latch orders agree; if not, the differences are unknown
  double time = 0, rate = 0, moment = 0, force = 0;
};
[[nodiscard]] Disagreement disagreement(const Figures& a, const Figures& b);

/// Makes references, or reads them from the file if it has them. Only one process may use a file at a time.
class ReferenceStore {
public:
  /// A file with other columns is ignored and later replaced.
  /// @param hinges names in Scene order, for the columns' headings
  ReferenceStore(std::filesystem::path file, std::vector<std::string> hinges);

  /// Returns the reference from the file. If the file lacks it, makes the run (seconds to minutes) and writes the file.
  [[nodiscard]] ReferenceRow get(const Scene& scene, int number, const ReferenceSettings& settings);

  /// Writes all references: first those that `get` returned, then the others of the file. Each of the first has its
  /// disagreement with its primary: the first returned reference of the same scene and latch.
  void write() const;

private:
  [[nodiscard]] std::string header() const;
  void read();
  void append(std::string& text, const ReferenceRow& row, const ReferenceRow* primary) const;
  /// The first returned reference of the row's scene and latch; nullptr for the primary itself.
  [[nodiscard]] const ReferenceRow* primary_of(const ReferenceRow& row) const;

  std::filesystem::path file_;
  std::vector<std::string> hinges_;
  std::vector<ReferenceRow> cached_; ///< read, but not returned by `get` yet
  std::vector<ReferenceRow> rows_;   ///< returned by `get`
};

} // namespace wingspread::study
