#include "plants/nonlinear/ode_integrator.hpp"

#include <cmath>
#include <utility>

#include <arkode/arkode_erkstep.h>
#include <fmt/format.h>

#include "base/error.hpp"
#include "plants/nonlinear/sundials_handles.hpp"

namespace mpm {
namespace {

using sundials::checked, sundials::require, sundials::say_nothing;
using sundials::Cvode, sundials::SunContext, sundials::SunLinearSolver, sundials::SunMatrix,
    sundials::SunVector;
using ErkStep = std::unique_ptr<void, sundials::FreeBy<ERKStepFree>>;

using ConstMap = Eigen::Map<const Eigen::VectorXd>;
using Map = Eigen::Map<Eigen::VectorXd>;

static_assert(CV_SUCCESS == 0 && ARK_SUCCESS == 0 && CV_TOO_MUCH_WORK == ARK_TOO_MUCH_WORK);
OdeStatus status_of(int flag) {
  if (flag >= 0)
    return OdeStatus::ok;
  return flag == CV_TOO_MUCH_WORK ? OdeStatus::step_limit : OdeStatus::failed;
}

void require_signal(const char* name, const Eigen::Ref<const Eigen::VectorXd>& signal, Eigen::Index size) {
  if (signal.size() != size)
    throw InputError(name, fmt::format("{} numbers", signal.size()), fmt::format("{}", size));
  if (!signal.allFinite())
    throw InputError(name, "a number that is not finite", "finite numbers");
}

}  // namespace

void OdeOptions::validate() const {
  // Below some hundred roundings the error test cannot be met.
  if (!(relative_tolerance >= 1e-13 && relative_tolerance < 1))
    throw InputError("relative_tolerance", fmt::to_string(relative_tolerance), "1e-13 to 1");
  if (!(absolute_tolerance > 0 && std::isfinite(absolute_tolerance)))
    throw InputError("absolute_tolerance", fmt::to_string(absolute_tolerance), "> 0");
  if (step_limit < 1)
    throw InputError("step_limit", fmt::to_string(step_limit), ">= 1");
}

// What the methods share: state, input, and f and df/dx as SUNDIALS calls them.
class OdeIntegrator::Implementation {
 public:
  explicit Implementation(std::shared_ptr<const OdeSystem> ode)
      : system(std::move(ode)),
        x(Eigen::VectorXd::Zero(system->state_count())),
        u(Eigen::VectorXd::Zero(system->input_count())),
        context(sundials::make_context()),
        vector(checked(SunVector(N_VMake_Serial(x.size(), x.data(), context.get())))) {}
  virtual ~Implementation() = default;
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  // Starts at time 0 from x. `fresh`: x was set; otherwise only u has changed since the last step. Keeps its
  // memory.
  virtual void start(bool fresh) = 0;
  // Integrates from `time` to `end`, both counted from the last start.
  virtual OdeStatus integrate(double end) = 0;

  static int derivative(realtype, N_Vector state, N_Vector rate, void* self) {
    const auto& integrator = *static_cast<const Implementation*>(self);
    const Eigen::Index n = integrator.x.size();
    Map dx(N_VGetArrayPointer(rate), n);
    integrator.system->derivative(ConstMap(N_VGetArrayPointer(state), n), integrator.u, dx);
    return dx.allFinite() ? 0 : 1;  // 1: CVODE tries a shorter step, ERKStep gives up
  }

  static int jacobian(realtype, N_Vector state, N_Vector, SUNMatrix J, void* self, N_Vector, N_Vector,
                      N_Vector) {
    const auto& integrator = *static_cast<const Implementation*>(self);
    const Eigen::Index n = integrator.x.size();
    Eigen::Map<Eigen::MatrixXd> entries(SUNDenseMatrix_Data(J), n, n);  // column by column, as in Eigen
    integrator.system->jacobian(ConstMap(N_VGetArrayPointer(state), n), integrator.u, entries);
    return entries.allFinite() ? 0 : 1;
  }

  std::shared_ptr<const OdeSystem> system;
  Eigen::VectorXd x, u;
  double time = 0.0;  // since the last start
  bool fresh = true;  // x was set since the last start
  // Each of these depends on those before it; x is the memory of `vector`.
  SunContext context;
  SunVector vector;
};

class OdeIntegrator::RungeKutta final : public Implementation {
 public:
  RungeKutta(std::shared_ptr<const OdeSystem> ode, const OdeOptions& options)
      : Implementation(std::move(ode)),
        erk_(checked(ErkStep(ERKStepCreate(derivative, 0.0, vector.get(), context.get())))) {
    require(ERKStepSetErrHandlerFn(erk_.get(), say_nothing, nullptr));
    require(ERKStepSetTableNum(erk_.get(), ARKODE_DORMAND_PRINCE_7_4_5));
    require(ERKStepSStolerances(erk_.get(), options.relative_tolerance, options.absolute_tolerance));
    require(ERKStepSetUserData(erk_.get(), static_cast<Implementation*>(this)));
    require(ERKStepSetMaxNumSteps(erk_.get(), options.step_limit));
  }

  // If only the input has changed, the length of the last step is a good one. If the state was set, a new
  // length is found, so that a loop does not depend on the one before it.
  void start(bool from_new_state) override {
    require(from_new_state ? ERKStepReInit(erk_.get(), derivative, 0.0, vector.get())
                           : ERKStepReset(erk_.get(), 0.0, vector.get()));
  }

  OdeStatus integrate(double end) override {
    require(ERKStepSetStopTime(erk_.get(), end));
    return status_of(ERKStepEvolve(erk_.get(), end, vector.get(), &time, ARK_NORMAL));
  }

 private:
  ErkStep erk_;
};

class OdeIntegrator::BackwardDifferentiation final : public Implementation {
 public:
  BackwardDifferentiation(std::shared_ptr<const OdeSystem> ode, const OdeOptions& options)
      : Implementation(std::move(ode)),
        matrix_(checked(SunMatrix(SUNDenseMatrix(x.size(), x.size(), context.get())))),
        linear_solver_(checked(SunLinearSolver(SUNLinSol_Dense(vector.get(), matrix_.get(), context.get())))),
        cvode_(checked(Cvode(CVodeCreate(CV_BDF, context.get())))) {
    require(CVodeSetErrHandlerFn(cvode_.get(), say_nothing, nullptr));
    require(CVodeInit(cvode_.get(), derivative, 0.0, vector.get()));
    require(CVodeSStolerances(cvode_.get(), options.relative_tolerance, options.absolute_tolerance));
    require(CVodeSetUserData(cvode_.get(), static_cast<Implementation*>(this)));
    require(CVodeSetLinearSolver(cvode_.get(), linear_solver_.get(), matrix_.get()));
    require(CVodeSetJacFn(cvode_.get(), jacobian));
    require(CVodeSetMaxNumSteps(cvode_.get(), options.step_limit));
  }

  // Forgets the past of the solution: its polynomials would run through the jump.
  void start(bool) override { require(CVodeReInit(cvode_.get(), 0.0, vector.get())); }

  OdeStatus integrate(double end) override {
    require(CVodeSetStopTime(cvode_.get(), end));
    return status_of(CVode(cvode_.get(), end, vector.get(), &time, CV_NORMAL));
  }

 private:
  SunMatrix matrix_;
  SunLinearSolver linear_solver_;
  Cvode cvode_;
};

OdeIntegrator::OdeIntegrator(std::shared_ptr<const OdeSystem> system, const OdeOptions& options) {
  if (!system)
    throw InputError("system to integrate", "none", "a system");
  options.validate();
  if (options.method == OdeMethod::runge_kutta)
    implementation_ = std::make_unique<RungeKutta>(std::move(system), options);
  else
    implementation_ = std::make_unique<BackwardDifferentiation>(std::move(system), options);
}

OdeIntegrator::~OdeIntegrator() = default;

void OdeIntegrator::reset(const Eigen::Ref<const Eigen::VectorXd>& x) {
  Implementation& my = *implementation_;
  require_signal("initial state", x, my.x.size());
  my.x = x;
  my.fresh = true;
}

OdeStatus OdeIntegrator::advance(const Eigen::Ref<const Eigen::VectorXd>& u, double duration) {
  Implementation& my = *implementation_;
  require_signal("plant inputs", u, my.u.size());
  if (!(duration > 0 && std::isfinite(duration)))
    throw InputError("duration", fmt::to_string(duration), "> 0");
  const bool changed = my.u != u;
  my.u = u;
  if (my.fresh || changed) {
    my.start(my.fresh);
    my.time = 0.0;
    my.fresh = false;
  }
  return my.integrate(my.time + duration);
}

const Eigen::VectorXd& OdeIntegrator::state() const {
  return implementation_->x;
}

}  // namespace mpm
