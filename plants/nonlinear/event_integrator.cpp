#include "plants/nonlinear/event_integrator.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <vector>

#include <fmt/format.h>

#include "base/system/forked_service.hpp"
#include "plants/nonlinear/sundials_handles.hpp"

namespace mpm {
namespace {

constexpr long kMostSteps = 1'000'000;        // in one communication step, events included
constexpr int kTryShorter = 1, kGiveUp = -1;  // return values, as CVODE understands them

}  // namespace

class EventIntegrator::Implementation {
 public:
  Implementation(EventSystem& equations, std::size_t states, std::size_t indicator_count);

  void start(double now);
  void advance(double now, double step);

 private:
  static int derivative(realtype time, N_Vector state, N_Vector rate, void* self);
  static int indicators(realtype time, N_Vector state, realtype* values, void* self);
  /// Runs `work` and keeps its exception, which must not pass through CVODE.
  template <class Work>
  int guarded(const Work& work);

  EventSystem& equations_;
  std::size_t states_;
  std::vector<double> x_;  ///< at least one: if there are no states, CVODE gets one that stays at rest
  double next_event_ = 0.0;
  std::exception_ptr thrown_;
  // Each of these depends on those before it.
  sundials::SunContext context_;
  sundials::SunVector vector_, tolerances_;
  sundials::SunMatrix matrix_;
  sundials::SunLinearSolver linear_solver_;
  sundials::Cvode cvode_;
};

EventIntegrator::Implementation::Implementation(EventSystem& equations, std::size_t states,
                                                std::size_t indicator_count)
    : equations_(equations),
      states_(states),
      x_(std::max<std::size_t>(states, 1), 0.0),
      context_(sundials::make_context()) {
  const auto n = static_cast<sunindextype>(x_.size());
  using sundials::checked, sundials::require;
  vector_ = checked(sundials::SunVector(N_VMake_Serial(n, x_.data(), context_.get())));
  tolerances_ = checked(sundials::SunVector(N_VNew_Serial(n, context_.get())));
  matrix_ = checked(sundials::SunMatrix(SUNDenseMatrix(n, n, context_.get())));
  linear_solver_ =
      checked(sundials::SunLinearSolver(SUNLinSol_Dense(vector_.get(), matrix_.get(), context_.get())));
  cvode_ = checked(sundials::Cvode(CVodeCreate(CV_BDF, context_.get())));
  require(CVodeSetErrHandlerFn(cvode_.get(), sundials::say_nothing, nullptr));
  require(CVodeInit(cvode_.get(), derivative, 0.0, vector_.get()));
  std::fill_n(N_VGetArrayPointer(tolerances_.get()), n, kTolerance);
  require(CVodeSVtolerances(cvode_.get(), kTolerance, tolerances_.get()));
  require(CVodeSetUserData(cvode_.get(), this));
  require(CVodeSetLinearSolver(cvode_.get(), linear_solver_.get(), matrix_.get()));
  if (indicator_count > 0)
    require(CVodeRootInit(cvode_.get(), static_cast<int>(indicator_count), indicators));
}

void EventIntegrator::Implementation::start(double now) {
  next_event_ = equations_.handle_events();
  if (states_ > 0) {
    equations_.get_states(x_.data());
    double* const tolerances = N_VGetArrayPointer(tolerances_.get());
    equations_.get_nominals(tolerances);
    for (std::size_t i = 0; i < states_; ++i)
      tolerances[i] = kTolerance * (tolerances[i] > 0 && std::isfinite(tolerances[i]) ? tolerances[i] : 1.0);
  }
  sundials::require(CVodeReInit(cvode_.get(), now, vector_.get()));
}

void EventIntegrator::Implementation::advance(double now, double step) {
  const double end = now + step;
  double time = now;
  for (long steps = 0; time < end; ++steps) {
    if (steps == kMostSteps)
      throw ForeignFailure(
          fmt::format("more than {} steps of its integration from its time {} on", kMostSteps, now));
    sundials::require(CVodeSetStopTime(cvode_.get(), std::min(end, std::max(next_event_, time))));
    const int flag =
        next_event_ <= time ? CV_TSTOP_RETURN : CVode(cvode_.get(), end, vector_.get(), &time, CV_ONE_STEP);
    if (thrown_)
      std::rethrow_exception(thrown_);
    if (flag < 0)
      throw ForeignFailure(
          fmt::format("its integration at its time {}: {}", time, CVodeGetReturnFlagName(flag)));
    equations_.set_time(time);
    if (states_ > 0)
      equations_.set_states(x_.data());
    if (equations_.completed_step() || flag == CV_ROOT_RETURN || next_event_ <= time) {
      equations_.enter_event_mode();
      start(time);
    }
  }
}

template <class Work>
int EventIntegrator::Implementation::guarded(const Work& work) {
  try {
    return work();
  } catch (...) {
    thrown_ = std::current_exception();
    return kGiveUp;
  }
}

int EventIntegrator::Implementation::derivative(realtype time, N_Vector state, N_Vector rate, void* self) {
  Implementation& my = *static_cast<Implementation*>(self);
  return my.guarded([&] {
    double* const dx = N_VGetArrayPointer(rate);
    if (my.states_ == 0)
      return dx[0] = 0.0, 0;
    my.equations_.set_time(time);
    my.equations_.set_states(N_VGetArrayPointer(state));
    my.equations_.get_derivatives(dx);
    return std::all_of(dx, dx + my.states_, [](double each) { return std::isfinite(each); }) ? 0
                                                                                             : kTryShorter;
  });
}

int EventIntegrator::Implementation::indicators(realtype time, N_Vector state, realtype* values, void* self) {
  Implementation& my = *static_cast<Implementation*>(self);
  return my.guarded([&] {
    my.equations_.set_time(time);
    if (my.states_ > 0)
      my.equations_.set_states(N_VGetArrayPointer(state));
    my.equations_.get_indicators(values);
    return 0;
  });
}

EventIntegrator::EventIntegrator(EventSystem& system, std::size_t states, std::size_t indicators) {
  if (states > kMostStates || indicators > kMostIndicators)
    throw ForeignFailure(
        fmt::format("{} states and {} event indicators, where at most {} and {} are integrated", states,
                    indicators, kMostStates, kMostIndicators));
  implementation_ = std::make_unique<Implementation>(system, states, indicators);
}

EventIntegrator::~EventIntegrator() = default;

void EventIntegrator::start(double now) {
  implementation_->start(now);
}

void EventIntegrator::advance(double now, double step) {
  implementation_->advance(now, step);
}

}  // namespace mpm
