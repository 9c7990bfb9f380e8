#include "montecarlo/report/drawing/labels.hpp"

#include "montecarlo/foundation/formats/text_layout.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace wingspread {
namespace {

constexpr double width_per_size =
    0.58;                   // of a character, of the font's size; digits have 0.556 in Helvetica
constexpr double blank = 3; // px on both sides of a text
constexpr double crumb = 6; // px: lines are kept free in pieces of this length
constexpr double nearest = 12, furthest = 170, ring = 11; // px from the anchor; heuristic, by eye
constexpr int directions = 16;

} // namespace

double text_width(const std::string& text, double size) {
  return width_per_size * size * static_cast<double>(count_characters(text));
}

void LabelPlaces::avoid(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const auto pieces = static_cast<int>(std::ceil((to - from).norm() / crumb)) + 1;
  for (int k = 0; k <= pieces; ++k) {
    const Eigen::Vector2d at = from + (to - from) * k / pieces, half{crumb / 2, crumb / 2};
    kept_free_.push_back({at - half, at + half});
  }
}

Box LabelPlaces::place(const std::string& text, double size, const Eigen::Vector2d& anchor,
                       const Eigen::Vector2d& away) {
  const Eigen::Vector2d half{text_width(text, size) / 2 + blank, 0.6 * size};
  const double preferred = std::atan2(away.y(), away.x());
  const auto is_free = [](const Box& box, const std::vector<Box>& others) {
    return std::ranges::none_of(others, [&](const Box& other) { return box.overlaps(other); });
  };
  std::optional<Box> fallback;
  for (double distance = nearest; distance <= furthest; distance += ring)
    for (int k = 0; k < directions; ++k) {
      const int aside = (k + 1) / 2 * (k % 2 == 0 ? 1 : -1); // 0, −1, 1, −2, 2, …
      const double angle = preferred + 2 * std::numbers::pi * aside / directions;
      const Eigen::Vector2d towards{std::cos(angle), std::sin(angle)};
      // The text's nearest edge is at this distance, whatever the direction.
      const Eigen::Vector2d middle = anchor + towards * distance + towards.cwiseProduct(half);
      const Box box{middle - half, middle + half};
      const bool inside = box.from.x() >= area_.from.x() && box.to.x() <= area_.to.x() &&
                          box.from.y() >= area_.from.y() && box.to.y() <= area_.to.y();
      if (!inside || !is_free(box, taken_)) continue;
      if (!fallback) fallback = box;
      if (!is_free(box, kept_free_)) continue;
      taken_.push_back(box);
      return box;
    }
  if (!fallback) fallback = Box{anchor - half, anchor + half};
  taken_.push_back(*fallback);
  return *fallback;
}

} // namespace wingspread
