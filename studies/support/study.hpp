/// Parts that the drivers share: command line, tables, the seed wing. Run the drivers from the repository's root.
#pragma once

#include "core/scene/scene.hpp"

#include <filesystem>
#include <functional>
#include <initializer_list>
#include <string>
#include <variant>
#include <vector>

namespace wingspread::study {

/// The options of the command line.
struct StudyOptions {
  bool quick = false;
  std::filesystem::path folder;   ///< for results; it exists
  std::vector<std::string> files; ///< named on the command line, of a driver that takes any
};

/// The main() of a driver: `--quick`, and `--out DIR`, results/NAME by default (…_quick with
/// --quick). @param files what files that the command line may name are for; null: none
/// @return the program's exit status: 2 when `study` throws
[[nodiscard]] int run_study(int count, char** arguments, const std::string& name,
                            const std::string& purpose,
                            const std::function<void(const StudyOptions&)>& study,
                            const char* files = nullptr);

/// A table to be written as CSV. Its columns' names hold their units, "k [N·m/rad]".
class Table {
public:
  using Cell = std::variant<double, std::string>; ///< a number that is not finite is left empty

  explicit Table(std::initializer_list<std::string> columns);

  /// Adds a row. @pre one cell per column
  void add(std::initializer_list<Cell> cells);

  /// @throws SpecError if the file cannot be written
  void write(const std::filesystem::path& file) const;

private:
  void append(const Cell& cell, bool first);

  std::size_t columns_;
  std::string text_;
};

/// scenes/three_panel.json.
[[nodiscard]] Scene seed_wing();

/// The seed wing with every latch of this stiffness, N·m/rad, and damping, N·m·s/rad.
[[nodiscard]] Scene seed_wing(double stiffness, double damping);

/// A folded stack of n equal panels, without latches.
[[nodiscard]] Scene stack(int n);

inline constexpr double seed_t_end = 12; ///< s; more than 5 s after the last latch

} // namespace wingspread::study
