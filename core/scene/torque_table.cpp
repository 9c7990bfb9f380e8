#include "core/scene/scene.hpp"

#include <utility>

namespace wingspread {

TorqueTable::TorqueTable(std::vector<double> angle, std::vector<double> torque,
                         Interpolation interpolation)
    : angle_(std::move(angle)), deploying_(std::move(torque)), interpolation_(interpolation),
      drive_(angle_, deploying_, interpolation) {}

TorqueTable::TorqueTable(std::vector<double> angle, std::vector<double> deploying,
                         std::vector<double> stowing, Interpolation interpolation)
    : angle_(std::move(angle)), deploying_(std::move(deploying)), stowing_(std::move(stowing)),
      interpolation_(interpolation) {
  const Curve out(angle_, deploying_, interpolation), back(angle_, stowing_, interpolation);
  drive_ = Curve::sum(0.5, back, 0.5, out);
  friction_ = Curve::sum(0.5, back, -0.5, out);
}

} // namespace wingspread
