/// Places the names in a drawing so that they overlap neither each other nor the lines.
#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

namespace wingspread {

/// A rectangle, px; y points down.
struct Box {
  Eigen::Vector2d from{0, 0}, to{0, 0};
  [[nodiscard]] bool overlaps(const Box& other) const {
    return from.x() < other.to.x() && other.from.x() < to.x() && from.y() < other.to.y() &&
           other.from.y() < to.y();
  }
};

/// An upper estimate of the width of a text of this size in a usual sans-serif font, px.
[[nodiscard]] double text_width(const std::string& text, double size);

class LabelPlaces {
public:
  /// @param area in which all labels have to stay
  explicit LabelPlaces(const Box& area) : area_(area) {}

  /// Keeps a line free of labels.
  void avoid(const Eigen::Vector2d& from, const Eigen::Vector2d& to);

  /// The box of the nearest free place for a text beside its anchor; of equally near places, the one closest to the
  /// direction `away`. Without a free place nearby, the nearest that overlaps no other text, though a line may cross
  /// it. Reserves the place.
  [[nodiscard]] Box place(const std::string& text, double size, const Eigen::Vector2d& anchor,
                          const Eigen::Vector2d& away = {1, 0});

private:
  Box area_;
  std::vector<Box> taken_, kept_free_;
};

} // namespace wingspread
