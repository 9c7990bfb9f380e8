#include "montecarlo/report/drawing/labels.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace wingspread;

TEST_CASE("labels of neighbouring points overlap neither each other nor a line") {
  LabelPlaces places({{0, 0}, {600, 400}});
  const Eigen::Vector2d from{100, 200}, to{500, 200};
  places.avoid(from, to);
  std::vector<Box> boxes;
  for (int k = 0; k < 8; ++k)
    boxes.push_back(places.place("panel_" + std::to_string(k), 13, {300.0 + 5 * k, 200}));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    CHECK((boxes[i].to.y() < 200 || boxes[i].from.y() > 200));
    CHECK(boxes[i].from.x() >= 0);
    CHECK(boxes[i].to.y() <= 400);
    for (std::size_t j = 0; j < i; ++j) CHECK_FALSE(boxes[i].overlaps(boxes[j]));
  }
}

TEST_CASE("labels of one point stand on all its sides before one stands further out") {
  const Eigen::Vector2d anchor{300, 200};
  for (const Eigen::Vector2d& away : {Eigen::Vector2d{1, 0}, {-1, 0}, {0.3, -0.8}}) {
    LabelPlaces places({{0, 0}, {600, 400}});
    double opposite = 0;
    for (int k = 0; k < 5; ++k) {
      const Box box = places.place("ab", 13, anchor, away);
      const Eigen::Vector2d side = (box.from + box.to) / 2 - anchor;
      CHECK((anchor.cwiseMax(box.from).cwiseMin(box.to) - anchor).norm() < 12.001);
      if (k == 0) CHECK(side.dot(away) > 0.9 * side.norm() * away.norm());
      opposite = std::min(opposite, side.dot(away));
    }
    CHECK(opposite < 0);
  }
}

TEST_CASE("a label without room is placed all the same") {
  LabelPlaces places({{0, 0}, {10, 10}});
  const Box box = places.place("a long name", 13, {5, 5});
  CHECK(box.to.x() > box.from.x());
}
