/// A function given by a table: monotone cubic or linear between knots, constant or straight beyond the ends.
///
/// | symbol  | meaning                                                                       |
/// |---------|-------------------------------------------------------------------------------|
/// | x_k, y_k| knots, x ascending                                                            |
/// | p_k     | the cubic from x_k to x_{k+1}, in powers of x − x_k                           |
/// | I_k     | ∫ of the function from x_0 to x_k                                             |
///
/// Monotone: the slopes are PCHIP's [F. N. Fritsch & J. Butland, A method for constructing local
/// monotone piecewise cubic interpolants, SIAM J. Sci. Stat. Comput. 5 (1984) 300-304; at the ends
/// the three-point formula, limited to keep the data's shape]. The curve
/// rises where the table rises, has its extremes at knots only, and reproduces a line.
#pragma once

#include <array>
#include <optional>
#include <vector>

namespace wingspread {

enum class Interpolation { monotone, linear };

/// Beyond the ends of a table.
enum class Beyond { constant, straight };

class Curve {
public:
  /// A polynomial piece: c[0] + c[1] u + c[2] u² + c[3] u³, u = x − x_k, and ∫ up to x_k.
  struct Piece {
    double from = 0;
    std::array<double, 4> c{};
    double integral = 0;
  };
  /// A point where the slope may be extreme, with its least and largest value there (both sides of a knot).
  struct Turn {
    double x, least, largest;
  };
  /// Up to eight pieces stored by columns, for lookups of eight lanes at once.
  struct Columns {
    std::array<double, 8> from;
    std::array<std::array<double, 8>, 4> c;
    std::array<double, 8> integral;
  };

  Curve() = default;
  /// @pre x strictly monotone, at least two knots, all finite. A descending table is reversed.
  Curve(std::vector<double> x, std::vector<double> y, Interpolation interpolation,
        Beyond beyond = Beyond::constant);

  /// a·f + b·g of two curves with the same knots.
  [[nodiscard]] static Curve sum(double a, const Curve& f, double b, const Curve& g);

  /// Value and slope at x by std::fma: the same bits on every processor, and those of curve_value.hpp if that is
  /// compiled with fused multiply-adds.
  [[nodiscard]] double value_at(double x) const;
  [[nodiscard]] double slope_at(double x) const;

  /// Pieces by ascending x: one before the first knot, one between each pair, one after the last.
  /// The piece at x is the last one that begins at or before x; the first begins at −∞, and its
  /// polynomial is in powers of x − x_0.
  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
  /// x_0 … x_n, ascending.
  [[nodiscard]] const std::vector<double>& knots() const { return knots_; }
  /// Knots, and inflections between knots.
  [[nodiscard]] const std::vector<Turn>& turns() const { return turns_; }
  /// The pieces by columns; none if there are more than eight.
  [[nodiscard]] const std::optional<Columns>& columns() const { return columns_; }
  /// Largest and least dy/dx anywhere.
  [[nodiscard]] double steepest_rise() const { return steepest_rise_; }
  [[nodiscard]] double steepest_fall() const { return steepest_fall_; }
  /// Largest |d²y/dx²| inside a piece.
  [[nodiscard]] double sharpest_bend() const { return sharpest_bend_; }
  /// Largest excess of the curve inside a piece over its values at the ends. It is only rounding, except for a sum of
  /// curves, which need not be monotone.
  [[nodiscard]] double overshoot() const { return overshoot_; }

private:
  [[nodiscard]] std::size_t piece_at(double x) const;
  void add_ends(Beyond beyond);
  void integrate();
  void find_slopes();
  void find_turns();
  void make_columns();

  std::vector<double> knots_;
  std::vector<Piece> pieces_;
  std::vector<Turn> turns_;
  std::optional<Columns> columns_;
  double steepest_rise_ = 0, steepest_fall_ = 0, sharpest_bend_ = 0, overshoot_ = 0;
};

} // namespace wingspread
