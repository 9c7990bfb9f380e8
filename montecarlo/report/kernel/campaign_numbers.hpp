/// A scene and its dispersions as a list of numbers. In this form the program passes them to the kernel in the page,
/// which cannot read JSON. One function visits every number in a fixed order; the program writes and the kernel reads
/// with it.
///
/// A pass has:  number(double&), integer(int&), list(std::vector<double>&), text(std::string&), and
///              `reads`, whether it fills what it visits.
/// A pass may keep the addresses that number() visits in the scene: they stay valid as long as the scene. Draws act
/// there.
#pragma once

#include "core/outcome.hpp"
#include "core/scene/base_table.hpp"
#include "core/scene/curve.hpp"
#include "core/scene/scene.hpp"
#include "distributions/copula.hpp"
#include "distributions/design.hpp"
#include "distributions/distribution.hpp"

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace wingspread {

/// How a draw changes one of the scene's numbers: by its value, or by the value of a table at the draw.
struct NumberedEffect {
  int how = 0;                   ///< 0: replaces, 1: multiplies, 2: is added
  int place = 0;                 ///< counted from 0 over the scene's numbers
  std::vector<double> at, value; ///< the table; empty: the draw itself
};

struct NumberedDispersion {
  std::string name;
  Distribution distribution;
  std::vector<NumberedEffect> effects;
};

/// All that a run depends on.
struct NumberedCampaign {
  Scene scene;
  std::vector<NumberedDispersion> dispersions;
  std::vector<RankCorrelation> correlations;
  Design design;
  Integration integration;
  Goal goal;
};

template <class Pass> class CampaignNumbers {
public:
  explicit CampaignNumbers(Pass& pass) : pass_(pass) {}

  /// The numbers at whose places effects act.
  void scene(Scene& scene) {
    base(scene.base);
    each(scene.bodies, [&](Body& body) {
      pass_.text(body.name);
      numbers({&body.mass, &body.inertia});
      present(body.plate, [&](Plate& plate) {
        vectors({&plate.from, &plate.to});
        numbers({&plate.width, &plate.drag_coefficient});
      });
    });
    each(scene.hinges, [&](Hinge& one) { hinge(one); });
    each(scene.synchronisations, [&](Synchronisation& one) { loop(one); });
    vectors({&scene.environment.gravity});
    numbers({&scene.environment.air_density});
  }

  void rest(NumberedCampaign& campaign) {
    each(campaign.dispersions, [&](NumberedDispersion& one) { dispersion(one); });
    each(campaign.correlations, [&](RankCorrelation& one) {
      whole(one.first);
      whole(one.second);
      numbers({&one.spearman});
    });
    word(campaign.design.kind);
    for (std::uint64_t* large :
         {&campaign.design.seed, &campaign.design.runs, &campaign.design.replicates})
      halves(*large);
    integration(campaign.integration);
    Goal& goal = campaign.goal;
    for (bool* flag : {&goal.peak_moment, &goal.peak_force, &goal.overtravel, &goal.base_motion,
                       &goal.hold_moment, &goal.motor_energy, &goal.final_angle, &goal.to_rest})
      whole(*flag);
  }

private:
  void numbers(std::initializer_list<double*> all) {
    for (double* number : all) pass_.number(*number);
  }
  void vectors(std::initializer_list<Eigen::Vector2d*> all) {
    for (Eigen::Vector2d* vector : all) numbers({&vector->x(), &vector->y()});
  }
  /// An index, a flag, or another small integer.
  template <class Integer> void whole(Integer& value) {
    int number = static_cast<int>(value);
    pass_.integer(number);
    value = static_cast<Integer>(number);
  }
  template <class Enum> void word(Enum& value) { whole(value); }
  /// 64 bits: a double holds 53.
  void halves(std::uint64_t& value) {
    double high = static_cast<double>(value >> 32), low = static_cast<double>(value & 0xffffffffu);
    numbers({&high, &low});
    value = (static_cast<std::uint64_t>(high) << 32) | static_cast<std::uint64_t>(low);
  }
  template <class Value, class Visit> void present(std::optional<Value>& value, Visit visit) {
    bool there = value.has_value();
    whole(there);
    if (!there) return;
    if (!value) value.emplace();
    visit(*value);
  }
  void present(std::optional<double>& value) {
    present(value, [&](double& number) { pass_.number(number); });
  }
  template <class Value, class Visit> void each(std::vector<Value>& values, Visit visit) {
    std::size_t count = values.size();
    whole(count);
    values.resize(count);
    for (Value& value : values) visit(value);
  }

  void base(Base& base) {
    word(base.motion);
    vectors({&base.acceleration, &base.position, &base.velocity});
    numbers({&base.angular_acceleration, &base.table_scale, &base.angle, &base.rate, &base.mass,
             &base.inertia});
    bool there = base.table != nullptr;
    whole(there);
    if (!there) return;
    BaseTable::Columns columns;
    Interpolation how{};
    if (base.table) {
      columns = base.table->columns();
      how = base.table->interpolation();
    }
    std::vector<double> x, y; // of the acceleration
    for (const Eigen::Vector2d& one : columns.acceleration) {
      x.push_back(one.x());
      y.push_back(one.y());
    }
    for (std::vector<double>* column :
         {&columns.time, &columns.angular_acceleration, &columns.rate, &x, &y})
      pass_.list(*column);
    columns.acceleration.clear();
    for (std::size_t i = 0; i < x.size(); ++i) columns.acceleration.emplace_back(x[i], y[i]);
    word(how);
    if (!base.table) base.table = std::make_shared<const BaseTable>(std::move(columns), how);
  }

  void torque(HingeTorque& torque) {
    numbers({&torque.torque_stowed, &torque.torque_latched, &torque.scale, &torque.offset});
    bool there = torque.table != nullptr;
    whole(there);
    if (!there) return;
    std::vector<double> angle, deploying, stowing;
    Interpolation how{};
    if (torque.table) {
      angle = torque.table->angle();
      deploying = torque.table->deploying();
      stowing = torque.table->stowing();
      how = torque.table->interpolation();
    }
    for (std::vector<double>* column : {&angle, &deploying, &stowing}) pass_.list(*column);
    word(how);
    if (torque.table) return;
    torque.table = std::make_shared<const TorqueTable>(
        stowing.empty() ? TorqueTable(angle, deploying, how)
                        : TorqueTable(angle, deploying, stowing, how));
  }

  void hinge(Hinge& hinge) {
    pass_.text(hinge.name); // reasons name it
    whole(hinge.parent);
    whole(hinge.child);
    vectors({&hinge.parent_point, &hinge.child_point});
    numbers({&hinge.stowed, &hinge.latched, &hinge.initial_rate});
    torque(hinge.spring);
    torque(hinge.harness);
    Friction& friction = hinge.friction;
    numbers({&friction.coulomb, &friction.viscous, &friction.regularization_rate, &friction.scale});
    present(friction.static_level);
    word(friction.model);
    present(hinge.damper, [&](Damper& damper) {
      word(damper.law);
      numbers({&damper.coefficient, &damper.exponent, &damper.regularization_rate,
               &damper.peak_torque, &damper.peak_rate, &damper.scale});
      present(damper.window, [&](auto& window) { numbers({&window[0], &window[1]}); });
    });
    present(hinge.joint, [&](Joint& joint) { numbers({&joint.stiffness, &joint.damping}); });
    for (std::optional<Stop>* side : {&hinge.stop, &hinge.far_stop})
      present(*side, [&](Stop& stop) { numbers({&stop.stiffness, &stop.dissipation, &stop.gap}); });
    present(hinge.latch, [&](Latch& latch) {
      numbers({&latch.stiffness, &latch.damping, &latch.backlash});
      present(latch.dissipation);
      present(latch.capture_rate);
      present(latch.holding_moment);
    });
    present(hinge.release, [&](Release& release) {
      word(release.event);
      whole(release.after);
      numbers({&release.time, &release.angle, &release.delay, &release.fails});
    });
    present(hinge.hold, [&](Hold& hold) { numbers({&hold.stiffness, &hold.damping}); });
    present(hinge.motor, [&](Motor& motor) {
      numbers({&motor.rate, &motor.scale, &motor.gain, &motor.torque_limit});
      word(motor.interpolation);
      bool there = motor.table != nullptr;
      whole(there);
      pass_.list(motor.time);
      pass_.list(motor.rates);
      if (there && !motor.table)
        motor.table = std::make_shared<const Curve>(motor.time, motor.rates, motor.interpolation);
    });
  }

  void loop(Synchronisation& loop) {
    whole(loop.first);
    whole(loop.second);
    numbers({&loop.ratio, &loop.stiffness, &loop.damping});
    present(loop.preload);
    bool there = loop.table != nullptr;
    whole(there);
    pass_.list(loop.travel);
    pass_.list(loop.travel_of_second);
    if (there && !loop.table)
      loop.table = std::make_shared<const Curve>(loop.travel, loop.travel_of_second,
                                                 Interpolation::monotone, Beyond::straight);
  }

  void dispersion(NumberedDispersion& dispersion) {
    pass_.text(dispersion.name);
    law(dispersion.distribution.law);
    present(dispersion.distribution.truncate, [&](Truncation& at) {
      numbers({&at.lower, &at.upper});
    });
    each(dispersion.effects, [&](NumberedEffect& effect) {
      whole(effect.how);
      whole(effect.place);
      pass_.list(effect.at);
      pass_.list(effect.value);
    });
  }

  void law(Law& law) {
    std::size_t kind = law.index();
    whole(kind);
    if constexpr (Pass::reads)
      law = law_of_kind(kind, std::make_index_sequence<std::variant_size_v<Law>>{});
    std::visit(
        [&]<class L>(L& own) {
          for (const auto& parameter : L::parameters()) value(own.*parameter.member);
        },
        law);
  }
  void value(double& number) { pass_.number(number); }
  void value(std::vector<double>& list) { pass_.list(list); }
  template <std::size_t... I> static Law law_of_kind(std::size_t kind, std::index_sequence<I...>) {
    Law law;
    (void)((kind == I ? (law.template emplace<I>(), true) : false) || ...);
    return law;
  }

  void integration(Integration& how) {
    pass_.text(how.method);
    numbers({&how.rtol, &how.atol, &how.t_end, &how.step});
    present(how.smoothing);
    double steps = static_cast<double>(how.max_steps);
    numbers({&steps});
    how.max_steps = static_cast<long>(steps);
  }

  Pass& pass_;
};

} // namespace wingspread
