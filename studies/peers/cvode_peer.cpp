#include "studies/peers/cvode_peer.hpp"

#include "core/mechanics/system.hpp"
#include "tests/support/cvode_handles.hpp"

#include <boost/math/tools/minima.hpp>

#include <array>
#include <limits>
#include <string>

namespace wingspread::study {

namespace {

using oracle::Owned;
using oracle::require;

/// What CVODE asks of a wing: of any topology, through C's void*.
class Problem {
public:
  virtual ~Problem() = default;
  virtual void differentiate(double t, const double* y, double* dydt) = 0;
  virtual void find_gaps(const double* y, double* gaps) = 0;
};

int right_hand_side(realtype t, N_Vector y, N_Vector dydt, void* problem) {
  static_cast<Problem*>(problem)->differentiate(t, N_VGetArrayPointer(y), N_VGetArrayPointer(dydt));
  return 0;
}

int root_functions(realtype, N_Vector y, realtype* gaps, void* problem) {
  static_cast<Problem*>(problem)->find_gaps(N_VGetArrayPointer(y), gaps);
  return 0;
}

} // namespace

/// CVODE's objects for states of one size.
struct CvodePeer::Memory {
  Memory(Kind kind, int dimension, int hinges) : size(dimension), roots(hinges) {
    SUNContext made = nullptr;
    require(SUNContext_Create(nullptr, &made), "SUNContext_Create");
    context.reset(made);
    y.reset(N_VNew_Serial(size, made));
    work.reset(N_VClone(y.get()));
    N_VConst(0, y.get());
    cvode.reset(CVodeCreate(kind == Kind::bdf ? CV_BDF : CV_ADAMS, made));
    require(CVodeSetErrFile(cvode.get(), nullptr), "CVodeSetErrFile"); // failures are values
    require(CVodeInit(cvode.get(), right_hand_side, 0, y.get()), "CVodeInit");
    matrix.reset(SUNDenseMatrix(size, size, made));
    linear.reset(SUNLinSol_Dense(y.get(), matrix.get(), made));
    require(CVodeSetLinearSolver(cvode.get(), linear.get(), matrix.get()), "CVodeSetLinearSolver");
    require(CVodeRootInit(cvode.get(), roots, root_functions), "CVodeRootInit");
    std::vector<int> direction(roots, 1);
    require(CVodeSetRootDirection(cvode.get(), direction.data()), "CVodeSetRootDirection");
  }

  int size, roots;
  Owned<SUNContext> context; // first made, last freed
  Owned<N_Vector> y, work;
  Owned<SUNMatrix> matrix;
  Owned<SUNLinearSolver> linear;
  Owned<void*> cvode;
};

namespace {

/// What a hinge's peak is of.
enum class Quantity { moment, force };

/// The peaks of one quantity.
struct Peaks {
  Quantity of;
  std::vector<Peak> highest;  ///< 1 … n
  std::vector<double> before; ///< 1 … n: at the step's start
};

/// One run.
/// @tparam Memory CvodePeer's
template <class Topology, class Memory> class Run final : public Problem {
public:
  Run(const Wing<double>& wing, Workspace<double>& work, Memory& memory, const Integration& how,
      const Goal& goal)
      : system_(wing, how.smoothing, work), memory_(memory), how_(how), goal_(goal) {
    const std::size_t hinges = system_.layout().bodies + 1;
    if (goal.peak_moment)
      peaks_.push_back({Quantity::moment, std::vector<Peak>(hinges), std::vector<double>(hinges)});
    if (goal.peak_force)
      peaks_.push_back({Quantity::force, std::vector<Peak>(hinges), std::vector<double>(hinges)});
    system_.want_forces(goal.peak_force);
  }

  [[nodiscard]] Outcome run() {
    start();
    while (t_ < how_.t_end && !(goal_.first_latch_only && !out_.latches.empty())) {
      if (out_.work.steps >= how_.max_steps) return end(Status::failed, "the limit of steps");
      const double from = t_;
      const int flag = CVode(cvode(), how_.t_end, memory_.y.get(), &t_, CV_ONE_STEP);
      if (flag < 0) return end(Status::failed, "CVODE's flag " + std::to_string(flag));
      ++out_.work.steps;
      load(memory_.y.get());
      if (t_ > from) raise_peaks(from);
      if (flag == CV_ROOT_RETURN) engage();
    }
    return end(latches_left() == 0 ? Status::deployed : Status::timed_out, "");
  }

  void differentiate(double t, const double* y, double* dydt) override {
    std::copy_n(y, memory_.size, x_.begin());
    system_(x_, dxdt_, t);
    std::copy_n(dxdt_.begin(), memory_.size, dydt);
  }

  void find_gaps(const double* y, double* gaps) override {
    for (int i = 1; i <= memory_.roots; ++i)
      gaps[i - 1] = waits(i) ? hinge(i).sense * (y[layout().angle(i)] - hinge(i).latched) : 1;
  }

private:
  [[nodiscard]] void* cvode() const { return memory_.cvode.get(); }
  [[nodiscard]] const Layout& layout() const { return system_.layout(); }
  [[nodiscard]] const HingeTerms<double>& hinge(int i) const { return system_.wing().hinges[i]; }
  [[nodiscard]] bool waits(int i) const { return hinge(i).has_latch && !system_.work().engaged[i]; }
  [[nodiscard]] int latches_left() const {
    int left = 0;
    for (int i = 1; i <= layout().bodies; ++i) left += waits(i);
    return left;
  }

  void start() {
    system_.start(x_);
    dxdt_ = x_;
    std::copy(x_.begin(), x_.end(), N_VGetArrayPointer(memory_.y.get()));
    require(CVodeSetUserData(cvode(), static_cast<Problem*>(this)), "CVodeSetUserData");
    require(CVodeSStolerances(cvode(), how_.rtol, how_.atol), "CVodeSStolerances");
    restart();
    observe_peaks();
  }

  /// The right-hand side has changed: CVODE's history is void.
  void restart() {
    require(CVodeReInit(cvode(), t_, memory_.y.get()), "CVodeReInit");
    require(CVodeSetStopTime(cvode(), how_.t_end), "CVodeSetStopTime");
  }

  void load(N_Vector y) { std::copy_n(N_VGetArrayPointer(y), memory_.size, x_.begin()); }

  void engage() {
    std::vector<int> found(memory_.roots);
    require(CVodeGetRootInfo(cvode(), found.data()), "CVodeGetRootInfo");
    for (int i = 1; i <= memory_.roots; ++i) {
      if (found[i - 1] == 0) continue;
      system_.engage(i);
      record_latch(i);
    }
    if (!how_.smoothing) restart();
    observe_peaks();
  }

  void record_latch(int i) {
    LatchEvent latch{system_.wing().hinge_of[i], t_, std::vector<double>(layout().bodies)};
    for (int j = 1; j <= layout().bodies; ++j)
      latch.rates[system_.wing().hinge_of[j]] = x_[layout().rate(j)];
    out_.latches.push_back(std::move(latch));
  }

  // ---- peaks

  /// |M| of hinge i, or its |reaction|, at the state now loaded, N·m or N.
  [[nodiscard]] double magnitude(Quantity of, int i) const {
    if (of == Quantity::moment) return std::abs(system_.moment(x_, i));
    const Vec2<double>& f = system_.work().forces[i];
    return std::sqrt(dot(f, f));
  }

  static void raise(Peak& peak, double value, double time) {
    if (value > peak.value) peak = {value, time};
  }

  /// Takes moments and forces as they stand at t.
  void observe_peaks() {
    if (goal_.peak_force) system_(x_, dxdt_, t_);
    for (Peaks& peaks : peaks_)
      for (int i = 1; i <= layout().bodies; ++i) {
        peaks.before[i] = magnitude(peaks.of, i);
        raise(peaks.highest[i], peaks.before[i], t_);
      }
  }

  /// A quantity at a time inside the last step, by CVODE's interpolant.
  [[nodiscard]] double value_at(Quantity of, int i, double time) {
    require(CVodeGetDky(cvode(), time, 0, memory_.work.get()), "CVodeGetDky");
    load(memory_.work.get());
    if (of == Quantity::force) system_(x_, dxdt_, time);
    return magnitude(of, i);
  }

  /// Raises the peaks to what is reached in the step from `from` to t.
  void raise_peaks(double from) {
    const std::vector<Peaks> old = peaks_;
    observe_peaks();
    for (std::size_t k = 0; k < peaks_.size(); ++k)
      for (int i = 1; i <= layout().bodies; ++i) {
        const double start = old[k].before[i];
        if (std::max(start, peaks_[k].before[i]) > 0.5 * old[k].highest[i].value)
          look_inside(peaks_[k], i, from, start);
      }
    load(memory_.y.get());
  }

  void look_inside(Peaks& peaks, int i, double from, double at_start) {
    constexpr int parts = 4;
    const double width = (t_ - from) / parts;
    std::array<double, parts + 1> samples{};
    samples.front() = at_start, samples.back() = peaks.before[i];
    for (int k = 1; k < parts; ++k) samples[k] = value_at(peaks.of, i, from + k * width);
    const auto best = std::max_element(samples.begin(), samples.end()) - samples.begin();
    const auto middle = std::clamp<std::ptrdiff_t>(best, 1, parts - 1);
    const double a = samples[middle - 1], b = samples[middle], c = samples[middle + 1];
    const double bend = a - 2 * b + c;
    const bool inside = bend < 0 && std::abs(a - c) < -3 * bend;
    if (!inside || b - (a - c) * (a - c) / (8 * bend) - bend < peaks.highest[i].value) return;
    refine(peaks, i, from + static_cast<double>(middle) * width, width);
  }

  /// The maximum within ± width of a time, by Brent's method on the way from there.
  void refine(Peaks& peaks, int i, double time, double width) {
    const auto found = boost::math::tools::brent_find_minima(
        [&](double s) { return -value_at(peaks.of, i, std::min(time + s * width, t_)); }, -1.0, 1.0,
        std::numeric_limits<double>::digits / 2);
    raise(peaks.highest[i], -found.second, time + found.first * width);
  }

  [[nodiscard]] Outcome end(Status status, std::string reason) {
    out_.status = status;
    out_.reason = std::move(reason);
    out_.t_end = t_;
    out_.work.rhs_evaluations = system_.work().evaluations;
    for (const Peaks& peaks : peaks_) {
      auto& told = peaks.of == Quantity::moment ? out_.peak_moment : out_.peak_force;
      told.resize(layout().bodies);
      for (int i = 1; i <= layout().bodies; ++i)
        told[system_.wing().hinge_of[i]] = peaks.highest[i];
    }
    return std::move(out_);
  }

  System<double, Topology, BaseMotion::fixed> system_;
  Memory& memory_;
  const Integration& how_;
  const Goal& goal_;
  State<double> x_, dxdt_;
  double t_ = 0;
  std::vector<Peaks> peaks_; ///< of what is asked for
  Outcome out_;
};

} // namespace

CvodePeer::CvodePeer(Kind kind) : kind_(kind) {}
CvodePeer::~CvodePeer() = default;
CvodePeer::CvodePeer(CvodePeer&&) noexcept = default;
CvodePeer& CvodePeer::operator=(CvodePeer&&) noexcept = default;

Outcome CvodePeer::run(const Scene& scene, const Integration& how, const Goal& goal) {
  if (scene.base.motion != BaseMotion::fixed)
    throw std::invalid_argument("CvodePeer: the base is not fixed");
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  const int n = wing.size(), size = (how.smoothing ? 3 : 2) * n;
  if (!memory_ || memory_->size != size || memory_->roots != n)
    memory_ = std::make_unique<Memory>(kind_, size, n);
  Workspace<double> work;
  if (n == 3 && is_chain(wing.tree))
    return Run<Chain<3>, Memory>(wing, work, *memory_, how, goal).run();
  return Run<Tree, Memory>(wing, work, *memory_, how, goal).run();
}

} // namespace wingspread::study
