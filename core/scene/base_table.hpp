/// Motion of a prescribed base by a table of time.
///
/// | symbol | meaning                                                                     | unit   |
/// |--------|-----------------------------------------------------------------------------|--------|
/// | t_k    | knots, ascending                                                            | s      |
/// | a      | acceleration of the base's origin, inertial axes                            | m/s²   |
/// | α      | angular acceleration                                                        | rad/s² |
/// | Ω      | rate                                                                        | rad/s  |
///
/// Each column is a curve [curve.hpp] between its knots, and constant beyond its ends. A table gives
/// α, or Ω (then α is the slope of Ω), or neither. Velocity, rate and angle are the exact integrals of
/// the curves from t = 0 on. Each piece of the table stores their values at its start.
#pragma once

#include "core/scene/curve.hpp"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace wingspread {

class BaseTable {
public:
  struct Columns {
    std::vector<double> time; ///< s
    std::vector<Eigen::Vector2d>
        acceleration; ///< m/s²; this and the next columns may be empty: not given
    std::vector<double> angular_acceleration; ///< rad/s²
    std::vector<double> rate;                 ///< rad/s; not with angular_acceleration
  };

  /// The motion from one knot to the next. Polynomials in powers of t − from; zero for a column not given.
  struct Piece {
    double from = 0;
    std::array<double, 4> x{}, y{};  ///< of a, m/s²
    std::array<double, 4> turning{}; ///< of α, rad/s²
    Eigen::Vector2d velocity{0, 0};  ///< ∫ a from 0 to `from`, m/s
    double rate = 0;                 ///< Ω, or ∫ α from 0 to `from`, rad/s
    double angle = 0;                ///< its integral from 0, rad
  };

  /// @pre time strictly ascending, at least two; each column empty or as many; all finite
  BaseTable(Columns columns, Interpolation interpolation);

  /// The columns as given, for writing the table out.
  [[nodiscard]] const Columns& columns() const { return columns_; }
  [[nodiscard]] Interpolation interpolation() const { return interpolation_; }
  [[nodiscard]] bool gives_acceleration() const { return !columns_.acceleration.empty(); }
  [[nodiscard]] bool gives_rate() const { return !columns_.rate.empty(); }
  /// Whether the table gives α, by a column or as the slope of the rate.
  [[nodiscard]] bool gives_turning() const {
    return gives_rate() || !columns_.angular_acceleration.empty();
  }

  /// Pieces before the first knot, between knots, and after the last. The first piece is in powers of t less the
  /// first knot.
  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }

private:
  void set_acceleration(const Curve& x, const Curve& y);
  void set_turning(const Curve& curve);
  void set_turning_by_rate(const Curve& curve);

  Columns columns_;
  Interpolation interpolation_;
  std::vector<Piece> pieces_;
};

} // namespace wingspread
