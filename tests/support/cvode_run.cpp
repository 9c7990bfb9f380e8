#include "tests/support/cvode_handles.hpp"
#include "tests/support/reference_ode.hpp"
#include "tests/support/reference_run.hpp"

namespace wingspread::oracle {

namespace {

using Ode = WingOde<double>;

Vector<double> values(N_Vector from) {
  return Eigen::Map<const Vector<double>>(N_VGetArrayPointer(from), N_VGetLength(from));
}

void assign(const Vector<double>& from, N_Vector to) {
  std::copy(from.begin(), from.end(), N_VGetArrayPointer(to));
}

int right_hand_side(realtype, N_Vector y, N_Vector derivative, void* data) {
  assign(static_cast<const Ode*>(data)->derivative(values(y)), derivative);
  return 0;
}

/// Two root functions per hinge. A root of the overtravel is the instant at which the hinge latches. A root of its rate is
/// a turning point: it ends the step, so CVODE notices a hinge that passes its latch and returns within one step.
int root_functions(realtype, N_Vector state, realtype* g, void* data) {
  const Ode& ode = *static_cast<const Ode*>(data);
  const Vector<double> y = values(state);
  for (int i = 0; i < ode.hinges(); ++i) {
    g[i] = ode.awaits_latch(i) ? ode.overtravel(i, y) : 1;
    g[ode.hinges() + i] = ode.awaits_latch(i) ? ode.overtravel_rate(i, y) : 1;
  }
  return 0;
}

/// CVODE's objects, freed in reverse order.
class Cvode {
public:
  Cvode(Ode& ode, const ReferenceOptions& options) : ode_(ode), options_(options) {
    SUNContext context = nullptr;
    require(SUNContext_Create(nullptr, &context), "SUNContext_Create");
    context_.reset(context);
    y_.reset(N_VNew_Serial(ode.dimension(), context));
    work_.reset(N_VClone(y_.get()));
    assign(ode.initial(), y_.get());
    memory_.reset(CVodeCreate(options.stiff ? CV_BDF : CV_ADAMS, context));
    require(CVodeInit(memory_.get(), right_hand_side, 0, y_.get()), "CVodeInit");
    set_tolerances();
    require(CVodeSetUserData(memory_.get(), &ode), "CVodeSetUserData");
    matrix_.reset(SUNDenseMatrix(ode.dimension(), ode.dimension(), context));
    solver_.reset(SUNLinSol_Dense(y_.get(), matrix_.get(), context));
    require(CVodeSetLinearSolver(memory_.get(), solver_.get(), matrix_.get()),
            "CVodeSetLinearSolver");
    require(CVodeSetMaxStep(memory_.get(), options.max_step), "CVodeSetMaxStep");
    require(CVodeSetStopTime(memory_.get(), options.t_end), "CVodeSetStopTime");
    require(CVodeRootInit(memory_.get(), 2 * ode.hinges(), root_functions), "CVodeRootInit");
    std::vector<int> direction(2 * ode.hinges(), 1);
    std::fill(direction.begin() + ode.hinges(), direction.end(), -1);
    require(CVodeSetRootDirection(memory_.get(), direction.data()), "CVodeSetRootDirection");
  }

  /// Makes one internal step, which ends early at a root. Returns whether it ended at a root.
  [[nodiscard]] bool step() {
    const int flag = CVode(memory_.get(), options_.t_end, y_.get(), &time_, CV_ONE_STEP);
    require(flag, "CVode");
    return flag == CV_ROOT_RETURN;
  }

  /// The hinge that latches at the root just found; −1 if the root is a turning point.
  [[nodiscard]] int latching_hinge() {
    std::vector<int> found(2 * ode_.hinges());
    require(CVodeGetRootInfo(memory_.get(), found.data()), "CVodeGetRootInfo");
    for (int i = 0; i < ode_.hinges(); ++i)
      if (found[i] > 0) return i;
    return -1;
  }

  void restart() {
    require(CVodeReInit(memory_.get(), time_, y_.get()), "CVodeReInit");
    require(CVodeSetStopTime(memory_.get(), options_.t_end), "CVodeSetStopTime");
  }

  [[nodiscard]] double time() const { return time_; }
  [[nodiscard]] Vector<double> state() const { return values(y_.get()); }

  /// The state at a time inside the last step, by CVODE's own interpolant.
  [[nodiscard]] Vector<double> state_at(double time) const {
    if (time == time_) return state();
    require(CVodeGetDky(memory_.get(), time, 0, work_.get()), "CVodeGetDky");
    return values(work_.get());
  }

private:
  /// Sets the tolerances. The smoothed latch's state S is of order ε, so its absolute tolerance is multiplied by ε.
  void set_tolerances() {
    Vector<double> absolute = Vector<double>::Constant(ode_.dimension(), options_.atol);
    if (options_.smoothing)
      absolute.segment(2 * ode_.hinges() + 6, ode_.hinges()) *= *options_.smoothing;
    assign(absolute, work_.get());
    require(CVodeSVtolerances(memory_.get(), options_.rtol, work_.get()), "CVodeSVtolerances");
  }

  Ode& ode_;
  const ReferenceOptions& options_;
  double time_ = 0;
  Owned<SUNContext> context_;
  Owned<N_Vector> y_, work_;
  Owned<SUNMatrix> matrix_;
  Owned<SUNLinearSolver> solver_;
  Owned<void*> memory_;
};

} // namespace

ReferenceOutcome cvode_run(const Scene& scene, const ReferenceOptions& options) {
  constexpr int samples_per_step = 6;
  Ode ode(scene, options.smoothing);
  if (ode.friction().any()) throw std::invalid_argument("cvode_run: exact friction is not smooth");
  Cvode cvode(ode, options);
  RunBook<double> book(ode, options, cvode.state());
  while (cvode.time() < options.t_end) {
    const double before = cvode.time();
    const bool met_root = cvode.step();
    if (cvode.time() > before)
      book.step(before, cvode.time(), samples_per_step,
                [&](double time) { return cvode.state_at(time); });
    const int hinge = met_root ? cvode.latching_hinge() : -1;
    if (hinge < 0) continue;
    book.latch(hinge, cvode.time(), cvode.state());
    if (!options.smoothing) cvode.restart();
  }
  return book.close(cvode.state());
}

} // namespace wingspread::oracle
