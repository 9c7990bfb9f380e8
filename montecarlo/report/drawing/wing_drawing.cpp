#include "montecarlo/report/drawing/wing_drawing.hpp"

#include "core/scene/torque.hpp"
#include "montecarlo/model/input_checks/placement.hpp"
#include "montecarlo/report/drawing/labels.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace wingspread {
namespace {

using Eigen::Vector2d;

constexpr double width = 1200, tallest = 420, shortest = 150; // of a view, px
constexpr double margin = 90, top = 64, gap = 34;             // px; names stand in the margin
constexpr double text_size = 13;                              // px
constexpr double arc_radius = 22, arc_sweep = 1.1, arrow_head = 0.32; // px, rad, rad
constexpr std::array colours{"#1b6ca8", "#b35a00", "#2e7d32", "#7b3fa0", "#a8323e", "#00737a"};

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text)
    if (c == '&')
      safe += "&amp;";
    else if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else
      safe += c;
  return safe;
}

/// A view's lines in the plane of the wing, m.
struct Segment {
  Vector2d from{0, 0}, to{0, 0};
  int body = base_index;
  bool assumed = false; ///< no plate says where the body ends
};

struct Pose {
  const char* title;
  double travel; ///< share of every hinge's travel
};

/// The bodies, hinge points and springs' senses of one pose.
class View {
public:
  View(const Scene& scene, const Pose& pose) : scene_(&scene), pose_(pose) {
    std::vector<double> angles;
    for (const Hinge& hinge : scene.hinges)
      angles.push_back(std::lerp(hinge.stowed, hinge.latched, pose.travel));
    bodies_ = place_bodies(scene, angles);
    if (scene.base.motion == BaseMotion::free) base_.position = scene.base.position;
    if (scene.base.motion != BaseMotion::fixed) base_.angle = scene.base.angle;
    for (const Hinge& hinge : scene.hinges) {
      points_.push_back(placed(hinge.parent, hinge.parent_point));
      if (hinge.parent == base_index)
        segments_.push_back({base_.position, points_.back(), base_index});
    }
    for (int b = 0; b < std::ssize(scene.bodies); ++b) add_body(b);
  }

  [[nodiscard]] const char* title() const { return pose_.title; }
  [[nodiscard]] const std::vector<Segment>& segments() const { return segments_; }
  [[nodiscard]] const std::vector<Vector2d>& points() const { return points_; }
  [[nodiscard]] const Vector2d& centre(int body) const { return bodies_[body].position; }
  [[nodiscard]] const Placement& base() const { return base_; }

  /// The direction from the hinge to its child's centre of mass, rad.
  [[nodiscard]] double towards_child(std::size_t h) const {
    const Vector2d arm = centre(scene_->hinges[h].child) - points_[h];
    return std::atan2(arm.y(), arm.x());
  }
  /// The sense in which the spring turns the child: 1 counter-clockwise, −1, or 0 without a torque.
  [[nodiscard]] int spring_sense(std::size_t h) const {
    const Hinge& hinge = scene_->hinges[h];
    const double torque = torque_at(hinge.spring, hinge, pose_.travel);
    const double sense = hinge.latched > hinge.stowed ? torque : -torque;
    return sense > 0 ? 1 : sense < 0 ? -1 : 0;
  }
  [[nodiscard]] bool deploys(std::size_t h) const {
    const Hinge& hinge = scene_->hinges[h];
    return torque_at(hinge.spring, hinge, pose_.travel) > 0;
  }

private:
  [[nodiscard]] Vector2d placed(int body, const Vector2d& point) const {
    const Placement& at = body == base_index ? base_ : bodies_[body];
    return at.position + Eigen::Rotation2Dd(at.angle) * point;
  }

  void add_body(int b) {
    const Body& body = scene_->bodies[b];
    if (body.plate)
      return segments_.push_back({placed(b, body.plate->from), placed(b, body.plate->to), b});
    Vector2d inner{0, 0};
    bool carries = false;
    for (const Hinge& hinge : scene_->hinges)
      if (hinge.child == b) inner = hinge.child_point;
    for (const Hinge& hinge : scene_->hinges)
      if (hinge.parent == b) {
        segments_.push_back({placed(b, inner), placed(b, hinge.parent_point), b});
        carries = true;
      }
    if (!carries) segments_.push_back({placed(b, inner), placed(b, -inner), b, true});
  }

  const Scene* scene_;
  Pose pose_;
  std::vector<Placement> bodies_;
  Placement base_;
  std::vector<Segment> segments_;
  std::vector<Vector2d> points_;
};

/// The place of a view on the page: metres to px.
class Frame {
public:
  Frame(const View& view, double above) {
    Vector2d least = view.base().position, most = least;
    const auto include = [&](const Vector2d& point) {
      least = least.cwiseMin(point);
      most = most.cwiseMax(point);
    };
    for (const Segment& segment : view.segments()) include(segment.from), include(segment.to);
    for (const Vector2d& point : view.points()) include(point);
    const Vector2d size = (most - least).cwiseMax(Vector2d{1e-9, 1e-9});
    scale_ = std::min((width - 2 * margin) / size.x(), (tallest - 2 * gap) / size.y());
    height_ = std::max(shortest, scale_ * size.y() + 2 * gap);
    middle_ = 0.5 * (least + most);
    above_ = above;
  }
  [[nodiscard]] Vector2d place(const Vector2d& point) const {
    const Vector2d from_middle = scale_ * (point - middle_);
    return {width / 2 + from_middle.x(), above_ + height_ / 2 - from_middle.y()};
  }
  [[nodiscard]] double scale() const { return scale_; } ///< px/m
  [[nodiscard]] double height() const { return height_; }
  [[nodiscard]] double above() const { return above_; }

private:
  double scale_ = 1, height_ = 0, above_ = 0;
  Vector2d middle_{0, 0};
};

std::string line(const Vector2d& from, const Vector2d& to, const std::string& style) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n",
                     from.x(), from.y(), to.x(), to.y(), style);
}

std::string text(const Vector2d& at, const std::string& what, const std::string& style) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", at.x(), at.y(), style,
                     escaped(what));
}

const char* colour_of(int body) {
  return body == base_index ? "#777" : colours[static_cast<std::size_t>(body) % colours.size()];
}

/// A point of the arc about a hinge, from its child's direction in the spring's sense.
Vector2d on_arc(const View& view, const Frame& frame, std::size_t h, double sweep, double radius) {
  const double angle = view.towards_child(h) + view.spring_sense(h) * sweep;
  return frame.place(view.points()[h]) + radius * Vector2d{std::cos(angle), -std::sin(angle)};
}

/// An arc with an arrow about a hinge.
std::string spring_arrow(const View& view, const Frame& frame, std::size_t h) {
  const int sense = view.spring_sense(h);
  if (sense == 0) return "";
  const auto at = [&](double sweep, double radius) {
    return on_arc(view, frame, h, sweep, radius);
  };
  const Vector2d from = at(0.15, arc_radius), neck = at(arc_sweep, arc_radius),
                 tip = at(arc_sweep + arrow_head, arc_radius),
                 inner = at(arc_sweep, arc_radius - 4), outer = at(arc_sweep, arc_radius + 4);
  const char* colour = view.deploys(h) ? "#0a7d4b" : "#c62828";
  return fmt::format(
      "<path class=\"spring\" d=\"M {:.1f} {:.1f} A {:.0f} {:.0f} 0 0 {} {:.1f} {:.1f}\" "
      "fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"/>\n"
      "<path d=\"M {:.1f} {:.1f} L {:.1f} {:.1f} L {:.1f} {:.1f} Z\" fill=\"{}\"/>\n",
      from.x(), from.y(), arc_radius, arc_radius, sense > 0 ? 0 : 1, neck.x(), neck.y(), colour,
      tip.x(), tip.y(), inner.x(), inner.y(), outer.x(), outer.y(), colour);
}

/// A bar of a round length, at the view's upper right.
std::string scale_bar(const Frame& frame) {
  const double most = 150 / frame.scale(), power = std::pow(10, std::floor(std::log10(most)));
  const double length = power * (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1);
  const Vector2d to{width - 20, frame.above() - 8}, from = to - Vector2d{length * frame.scale(), 0};
  return line(from, to, "stroke=\"#333\" stroke-width=\"2\"") +
         text(from - Vector2d{8, -4}, fmt::format("{:g} m", length),
              "text-anchor=\"end\" fill=\"#333\"");
}

std::string label(LabelPlaces& places, const Vector2d& anchor, const Vector2d& middle_of_all,
                  const std::string& name, const char* colour, bool bold) {
  const Box box = places.place(name, text_size, anchor, anchor - middle_of_all);
  const Vector2d middle = 0.5 * (box.from + box.to);
  const Vector2d near = anchor.cwiseMax(box.from).cwiseMin(box.to);
  std::string drawn;
  if ((near - anchor).norm() > 16)
    drawn = line(anchor, near, fmt::format("stroke=\"{}\" stroke-width=\"0.6\"", colour));
  return drawn + text({middle.x(), middle.y() + 0.35 * text_size}, name,
                      fmt::format("text-anchor=\"middle\" fill=\"{}\"{}", colour,
                                  bold ? " font-weight=\"bold\"" : ""));
}

std::string labels(const Scene& scene, const View& view, const Frame& frame) {
  LabelPlaces places({{4, frame.above()}, {width - 4, frame.above() + frame.height()}});
  for (const Segment& segment : view.segments())
    places.avoid(frame.place(segment.from), frame.place(segment.to));
  for (std::size_t h = 0; h < view.points().size(); ++h) {
    const auto arc = [&](double sweep) { return on_arc(view, frame, h, sweep, arc_radius); };
    if (view.spring_sense(h) != 0)
      places.avoid(arc(0), arc(arc_sweep / 2)),
          places.avoid(arc(arc_sweep / 2), arc(arc_sweep + arrow_head));
  }
  Vector2d middle{0, 0}; // of the hinges: names stand outside
  for (const Vector2d& point : view.points())
    middle += frame.place(point) / static_cast<double>(view.points().size());
  std::string drawn;
  for (std::size_t h = 0; h < scene.hinges.size(); ++h)
    drawn +=
        label(places, frame.place(view.points()[h]), middle, scene.hinges[h].name, "#222", true);
  for (int b = 0; b < std::ssize(scene.bodies); ++b)
    drawn += label(places, frame.place(view.centre(b)), middle, scene.bodies[b].name, colour_of(b),
                   false);
  return drawn + label(places, frame.place(view.base().position), middle, "base", "#555", false);
}

std::string draw(const Scene& scene, const View& view, const Frame& frame) {
  std::string drawn = text({20, frame.above() - 8}, view.title(), "font-size=\"16\" fill=\"#000\"");
  drawn += scale_bar(frame);
  for (const Segment& segment : view.segments())
    drawn += line(frame.place(segment.from), frame.place(segment.to),
                  fmt::format("stroke=\"{}\" stroke-width=\"{}\"{}", colour_of(segment.body),
                              segment.body == base_index ? 6 : 3,
                              segment.assumed ? " stroke-dasharray=\"7 4\"" : ""));
  for (std::size_t h = 0; h < scene.hinges.size(); ++h) {
    const Vector2d at = frame.place(view.points()[h]);
    drawn += spring_arrow(view, frame, h);
    drawn +=
        fmt::format("<circle class=\"hinge\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"#fff\" "
                    "stroke=\"#222\" stroke-width=\"1.5\"/>\n",
                    at.x(), at.y());
  }
  for (int b = 0; b < std::ssize(scene.bodies); ++b) {
    const Vector2d at = frame.place(view.centre(b));
    drawn += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.5\" fill=\"{}\"/>\n", at.x(),
                         at.y(), colour_of(b));
  }
  return drawn + labels(scene, view, frame);
}

} // namespace

std::string draw_wing(const Scene& scene) {
  constexpr std::array poses{Pose{"stowed", 0},
                             Pose{"half-way: every hinge at half of its travel", 0.5},
                             Pose{"deployed", 1}};
  std::string drawn;
  double above = top + 30;
  for (const Pose& pose : poses) {
    const View view(scene, pose);
    const Frame frame(view, above);
    drawn += draw(scene, view, frame);
    above += frame.height() + 36;
  }
  return fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
                     "width=\"{0:.0f}\" "
                     "height=\"{1:.0f}\" font-family=\"Helvetica, Arial, sans-serif\" "
                     "font-size=\"{2:.0f}\">\n"
                     "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
                     width, above, text_size) +
         text({20, 32}, scene.name, "font-size=\"20\" font-weight=\"bold\"") +
         text({20, 52},
              "circle: hinge axis · dot: centre of mass · green arrow: the spring turns its child "
              "that way, towards the latch (red: away from it)",
              "fill=\"#555\"") +
         drawn + "</svg>\n";
}

} // namespace wingspread
