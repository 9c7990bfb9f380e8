#include "core/proofs/natural_modes.hpp"
#include "montecarlo/report/page/modes_json.hpp"
#include "tests/support/bending_scenes.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <complex>
#include <functional>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

using Complex = std::complex<double>;
Complex complex(const Eigen::Vector2d& point) { return {point.x(), point.y()}; }

/// The common centre of mass of a wing in a pose, by the chain of hinges from the base to each body.
Complex center_of_mass(const Scene& scene, const std::vector<double>& angles, Complex base,
                       double turned) {
  struct Place {
    Complex at;
    double angle;
  };
  const std::function<Place(int)> place = [&](int body) {
    if (body == base_index) return Place{base, turned};
    const auto is_its = [&](const Hinge& hinge) { return hinge.child == body; };
    const auto hinge = std::find_if(scene.hinges.begin(), scene.hinges.end(), is_its);
    const Place parent = place(hinge->parent);
    const double angle =
        parent.angle + angles[static_cast<std::size_t>(hinge - scene.hinges.begin())];
    return Place{parent.at + std::polar(1., parent.angle) * complex(hinge->parent_point) -
                     std::polar(1., angle) * complex(hinge->child_point),
                 angle};
  };
  Complex sum = scene.base.mass * base;
  double mass = scene.base.mass;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    sum += scene.bodies[b].mass * place(static_cast<int>(b)).at;
    mass += scene.bodies[b].mass;
  }
  return sum / mass;
}

} // namespace

TEST_CASE("the page's modes are the lowest, and move no free wing's centre of mass", "[page]") {
  for (const Scene& scene : {symmetric_tree(), two_wing_free_spacecraft()}) {
    const std::optional<WingModes> modes = natural_modes(scene);
    REQUIRE(modes);
    const Json json = modes_json(scene);
    const std::size_t shown = std::min<std::size_t>(modes->modes.size(), 6);
    REQUIRE(json["modes"].size() == shown);
    const Scene& wing = modes->wing.scene;
    const auto rest = json["rest"].get<std::vector<double>>();
    for (std::size_t k = 0; k < shown; ++k) {
      const Json& mode = json["modes"][k];
      CAPTURE(k);
      CHECK(mode["frequency"].get<double>() == Approx(modes->modes[k].frequency).epsilon(1e-5));
      if (k > 0) CHECK(mode["frequency"] >= json["modes"][k - 1]["frequency"]);
      const auto shape = mode["shape"].get<std::vector<double>>();
      REQUIRE(shape.size() == wing.hinges.size());
      const Json& base = mode["base"];
      const auto center = [&](double amplitude) {
        std::vector<double> angles = rest;
        for (std::size_t h = 0; h < angles.size(); ++h) angles[h] += amplitude * shape[h];
        const Complex moved(base["x"].get<double>(), base["y"].get<double>());
        return center_of_mass(wing, angles, complex(wing.base.position) + amplitude * moved,
                              wing.base.angle + amplitude * base["angle"].get<double>());
      };
      // to first order; the page's numbers have six digits
      CHECK(std::abs(center(1e-3) - center(-1e-3)) / 2e-3 < 1e-4);
    }
  }
}

TEST_CASE("a fixed wing's modes move no base, and an unphysical wing has none", "[page]") {
  Scene scene = seed_scene();
  const Json json = modes_json(scene);
  REQUIRE_FALSE(json["modes"].empty());
  for (const Json& mode : json["modes"]) CHECK(mode["base"].is_null());
  scene.bodies[0].mass = -1;
  CHECK(modes_json(scene).is_null());
}
