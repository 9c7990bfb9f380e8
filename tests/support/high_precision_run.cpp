#include "tests/support/reference_ode.hpp"
#include "tests/support/reference_run.hpp"

#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include <stdexcept>

namespace wingspread::oracle {

namespace {

/// Fehlberg's order-8 formula, which reaches every point of interest by a real step. Two half steps give the error. The
/// embedded error estimate compares only stages at the two ends of the step, so it cannot see errors of quadratures, such
/// as that of Ṡ = f(φ(t)) of a smoothed latch.
template <class Scalar> class Fehlberg {
public:
  Fehlberg(WingOde<Scalar>& ode, const ReferenceOptions& options)
      : ode_(ode), options_(options), book_(ode, options, ode.initial()), y_(ode.initial()) {
    book_.settle(time_, y_);
  }

  [[nodiscard]] ReferenceOutcome run() {
    const Scalar end = options_.t_end;
    while (time_ < end) {
      const Scalar h = std::min<Scalar>({step_, Scalar(options_.max_step), end - time_});
      const Vector<Scalar> next = stepped(stepped(h / 2), h / 2);
      const Scalar off = error(stepped(h), next);
      step_ = h * growth(off);
      if (!(off <= 1)) {
        if (time_ + step_ == time_) throw std::runtime_error("Fehlberg: the step size underflows");
        continue;
      }
      accept(h, next, h == end - time_);
    }
    return book_.close(y_);
  }

private:
  using State = std::vector<Scalar>;
  using Stepper = boost::numeric::odeint::runge_kutta_fehlberg78<State, Scalar, State, Scalar>;

  /// The state a step of h after y.
  [[nodiscard]] Vector<Scalar> stepped(const Vector<Scalar>& y, const Scalar& h) const {
    const State from(y.begin(), y.end());
    State to(from.size());
    const auto system = [&](const State& at, State& derivative, const Scalar&) {
      const Vector<Scalar> d =
          ode_.derivative(Eigen::Map<const Vector<Scalar>>(at.data(), y.size()));
      std::copy(d.begin(), d.end(), derivative.begin());
    };
    Stepper().do_step(system, from, Scalar(0), to, h);
    return Eigen::Map<const Vector<Scalar>>(to.data(), y.size());
  }

  /// The state a step of h after the current one.
  [[nodiscard]] Vector<Scalar> stepped(const Scalar& h) const { return stepped(y_, h); }

  /// The largest difference between two states, as a multiple of the tolerance.
  [[nodiscard]] Scalar error(const Vector<Scalar>& whole, const Vector<Scalar>& halves) const {
    using std::abs;
    using std::max;
    Scalar largest{0};
    for (Eigen::Index i = 0; i < y_.size(); ++i) {
      const Scalar size = max<Scalar>(abs(y_(i)), abs(halves(i)));
      const Scalar part = abs(whole(i) - halves(i)) / (absolute(i) + options_.rtol * size);
      if (part > largest || part != part) largest = part; // a NaN stays
    }
    return largest;
  }

  /// The absolute tolerance of an entry. The smoothed latch's state S is of order ε, so its tolerance is multiplied by ε.
  [[nodiscard]] Scalar absolute(Eigen::Index entry) const {
    const Eigen::Index mechanical = 2 * ode_.hinges() + 6;
    return entry < mechanical ? options_.atol : options_.atol * options_.smoothing.value_or(1);
  }

  [[nodiscard]] static Scalar growth(const Scalar& off) {
    using std::pow;
    if (!(off < 1e30)) return Scalar(0.1);
    const double factor = 0.9 * pow(static_cast<double>(off) + 1e-30, -1. / 9);
    return Scalar(std::clamp(factor, 0.2, 4.));
  }

  /// Advances by h, or to the first latch or change of contact within h.
  void accept(Scalar h, Vector<Scalar> next, bool to_end) {
    const Scalar whole = h;
    const int latching = first_latch(h, next), touching = first_contact(h, whole, next);
    const int hinge = touching >= 0 ? -1 : latching;
    const bool event = hinge >= 0 || touching >= 0;
    if (event) next = stepped(h);
    const Scalar upper = to_end && !event ? Scalar(options_.t_end) : Scalar(time_ + h);
    const int intervals =
        ode_.smoothed() ? 12 : 2; // few samples miss the kinks of a smoothed latch
    book_.step(time_, upper, intervals, [&](const Scalar& time) -> Vector<Scalar> {
      if (time == time_) return y_;
      return time == upper ? next : stepped(time - time_);
    });
    time_ = upper;
    y_ = next;
    if (!event) return;
    if (touching >= 0) {
      if (!ode_.friction().sticks(touching)) ode_.stop(touching, y_);
      book_.settle(time_, y_);
    } else {
      book_.latch(hinge, time_, y_);
    }
    if (!ode_.smoothed()) step_ = std::min<Scalar>(step_, Scalar(1e-4));
  }

  /// The hinge that latches first within a step of h that ends in `next`; −1 if none does. Reduces h to the step that ends
  /// at this latch.
  [[nodiscard]] int first_latch(Scalar& h, const Vector<Scalar>& next) const {
    int first = -1;
    const Scalar whole = h;
    for (int i = 0; i < ode_.hinges(); ++i) {
      if (!ode_.awaits_latch(i)) continue;
      Scalar past = whole; // a step after which hinge i may be past its latch
      const auto travel = [&](const Vector<Scalar>& y) { return ode_.overtravel(i, y); };
      const auto slowing = [&](const Vector<Scalar>& y) {
        return Scalar(-ode_.overtravel_rate(i, y));
      };
      if (travel(next) < 0) {
        if (!(slowing(y_) < 0 && slowing(next) > 0)) continue;
        past = crossing(whole, slowing); // the hinge turns back, perhaps beyond its latch
        if (travel(stepped(past)) < 0) continue;
      }
      const Scalar at = travel(y_) < 0 ? crossing(past, travel) : Scalar(0);
      if (first >= 0 && !(at < h)) continue;
      first = i;
      h = at;
    }
    return first;
  }

  /// The hinge whose exact friction first changes its contact (slides, sticks) before h; −1 if none does. Reduces h to the
  /// step that ends at this change. A change that is undone before the step's end shows in the state at its middle.
  /// @param whole the step that ends in `next`
  [[nodiscard]] int first_contact(Scalar& h, const Scalar& whole,
                                  const Vector<Scalar>& next) const {
    if (!ode_.friction().any()) return -1;
    int first = -1;
    const Vector<Scalar> middle = stepped(whole / 2);
    for (int i = 0; i < ode_.hinges(); ++i) {
      const auto gap = [&](const Vector<Scalar>& y) { return ode_.contact_gap(i, y); };
      Scalar past = whole;
      if (gap(middle) >= 0)
        past = whole / 2;
      else if (!(gap(next) >= 0))
        continue;
      // a hinge that has just begun to slide starts with a gap of 0
      const Scalar at = gap(y_) < 0 ? crossing(past, gap) : crossing_after_start(past, gap);
      if (!(at < h)) continue;
      first = i;
      h = at;
    }
    return first;
  }

  template <class Function>
  [[nodiscard]] Scalar crossing_after_start(const Scalar& upper, const Function& g) const {
    if (!(g(stepped(upper / 1024)) < 0))
      throw std::runtime_error("Fehlberg: a hinge that was let go does not move");
    return crossing(upper, g, upper / 1024);
  }

  /// The length of the step at whose end g(y) changes from < 0 to ≥ 0, by the Illinois method with real steps. The result
  /// lies on the side g ≥ 0.
  template <class Function>
  [[nodiscard]] Scalar crossing(Scalar upper, const Function& g, Scalar lower = 0) const {
    using std::abs;
    Scalar below = g(lower > 0 ? stepped(lower) : y_), above = g(stepped(upper));
    int side = 0;
    const Scalar least = 4 * std::numeric_limits<Scalar>::epsilon() * (time_ + upper);
    for (int i = 0; i < 200 && upper - lower > least && above != 0; ++i) {
      Scalar trial = (lower * above - upper * below) / (above - below);
      if (!(trial > lower && trial < upper)) trial = (lower + upper) / 2;
      if (trial == lower || trial == upper) break;
      const Scalar value = g(stepped(trial));
      if (value >= 0) {
        upper = trial;
        above = value;
        if (side == 1) below /= 2;
        side = 1;
      } else {
        lower = trial;
        below = value;
        if (side == -1) above /= 2;
        side = -1;
      }
    }
    return upper;
  }

  WingOde<Scalar>& ode_;
  const ReferenceOptions& options_;
  RunBook<Scalar> book_;
  Vector<Scalar> y_;
  Scalar time_{0};
  Scalar step_{1e-4};
};

} // namespace

template <class Scalar>
ReferenceOutcome high_precision_run(const Scene& scene, const ReferenceOptions& options) {
  WingOde<Scalar> ode(scene, options.smoothing);
  return Fehlberg<Scalar>(ode, options).run();
}

template ReferenceOutcome high_precision_run<long double>(const Scene&, const ReferenceOptions&);
template ReferenceOutcome high_precision_run<Quad>(const Scene&, const ReferenceOptions&);

} // namespace wingspread::oracle
