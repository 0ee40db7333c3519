#include "plants/outside/fmu_integrator.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "plants/system/forked_service.hpp"

namespace mpm {
namespace {

constexpr long kMostSteps = 1'000'000;        // of a communication step, events included
constexpr int kTryShorter = 1, kGiveUp = -1;  // what CVODE makes of the answer of a function

}  // namespace

FmuIntegrator::FmuIntegrator(FmuEquations& equations, std::size_t states, std::size_t indicator_count)
    : equations_(equations),
      states_(states),
      x_(std::max<std::size_t>(states, 1), 0.0),
      context_(sundials::make_context()) {
  const auto n = static_cast<sunindextype>(x_.size());
  using sundials::checked, sundials::require;
  vector_ = checked(sundials::Vector(N_VMake_Serial(n, x_.data(), context_.get())));
  tolerances_ = checked(sundials::Vector(N_VNew_Serial(n, context_.get())));
  matrix_ = checked(sundials::Matrix(SUNDenseMatrix(n, n, context_.get())));
  linear_solver_ =
      checked(sundials::LinearSolver(SUNLinSol_Dense(vector_.get(), matrix_.get(), context_.get())));
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

void FmuIntegrator::start(double now) {
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

void FmuIntegrator::advance(double now, double step) {
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
int FmuIntegrator::guarded(const Work& work) {
  try {
    return work();
  } catch (...) {
    thrown_ = std::current_exception();
    return kGiveUp;
  }
}

int FmuIntegrator::derivative(realtype time, N_Vector state, N_Vector rate, void* self) {
  FmuIntegrator& my = *static_cast<FmuIntegrator*>(self);
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

int FmuIntegrator::indicators(realtype time, N_Vector state, realtype* values, void* self) {
  FmuIntegrator& my = *static_cast<FmuIntegrator*>(self);
  return my.guarded([&] {
    my.equations_.set_time(time);
    if (my.states_ > 0)
      my.equations_.set_states(N_VGetArrayPointer(state));
    my.equations_.get_indicators(values);
    return 0;
  });
}

}  // namespace mpm
