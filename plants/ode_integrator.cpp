#include "plants/ode_integrator.hpp"

#include <cmath>
#include <new>
#include <utility>

#include <cvode/cvode.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "plants/error.hpp"

namespace mpm {
namespace {

// The deleter of a handle that SUNDIALS frees by its value, or by its address.
template <auto Free>
struct FreeBy {
  template <class T>
  void operator()(T* handle) const {
    if constexpr (requires { Free(handle); })
      Free(handle);
    else
      Free(&handle);
  }
};

using Context = std::unique_ptr<std::remove_pointer_t<SUNContext>, FreeBy<SUNContext_Free>>;
using Vector = std::unique_ptr<std::remove_pointer_t<N_Vector>, FreeBy<N_VDestroy>>;
using Matrix = std::unique_ptr<std::remove_pointer_t<SUNMatrix>, FreeBy<SUNMatDestroy>>;
using LinearSolver = std::unique_ptr<std::remove_pointer_t<SUNLinearSolver>, FreeBy<SUNLinSolFree>>;

struct FreeCvode {
  void operator()(void* memory) const { CVodeFree(&memory); }
};
using Cvode = std::unique_ptr<void, FreeCvode>;

using ConstMap = Eigen::Map<const Eigen::VectorXd>;
using Map = Eigen::Map<Eigen::VectorXd>;

// With sizes and pointers that are right, only memory can be missing.
template <class Handle>
Handle checked(Handle handle) {
  if (!handle)
    throw std::bad_alloc();
  return handle;
}

void require(int flag) {
  if (flag != CV_SUCCESS)
    throw std::bad_alloc();
}

Context make_context() {
  SUNContext context = nullptr;
  if (SUNContext_Create(nullptr, &context) != 0)
    throw std::bad_alloc();
  return Context(context);
}

// Outcomes are told by the status; nothing is printed.
void say_nothing(int, const char*, const char*, char*, void*) {}

void require_signal(const char* name, const Eigen::Ref<const Eigen::VectorXd>& signal, Eigen::Index size) {
  if (signal.size() != size)
    throw InputError(name, fmt::format("{} numbers", signal.size()), fmt::format("{}", size));
  if (!signal.allFinite())
    throw InputError(name, "a number that is not finite", "finite numbers");
}

}  // namespace

void OdeOptions::validate() const {
  // Below some hundred roundings the error test of CVODE cannot be met.
  if (!(relative_tolerance >= 1e-13 && relative_tolerance < 1))
    throw InputError("relative_tolerance", fmt::to_string(relative_tolerance), "1e-13 to 1");
  if (!(absolute_tolerance > 0 && std::isfinite(absolute_tolerance)))
    throw InputError("absolute_tolerance", fmt::to_string(absolute_tolerance), "> 0");
  if (step_limit < 1)
    throw InputError("step_limit", fmt::to_string(step_limit), ">= 1");
}

class OdeIntegrator::Implementation {
 public:
  Implementation(std::shared_ptr<const OdeSystem> ode, const OdeOptions& options)
      : system(std::move(ode)), context(make_context()) {
    const Eigen::Index n = system->state_count();
    x.setZero(n);
    u.setZero(system->input_count());
    vector = checked(Vector(N_VMake_Serial(n, x.data(), context.get())));
    matrix = checked(Matrix(SUNDenseMatrix(n, n, context.get())));
    linear_solver = checked(LinearSolver(SUNLinSol_Dense(vector.get(), matrix.get(), context.get())));
    cvode = checked(Cvode(CVodeCreate(CV_BDF, context.get())));
    require(CVodeSetErrHandlerFn(cvode.get(), say_nothing, nullptr));
    require(CVodeInit(cvode.get(), derivative, 0.0, vector.get()));
    require(CVodeSStolerances(cvode.get(), options.relative_tolerance, options.absolute_tolerance));
    require(CVodeSetUserData(cvode.get(), this));
    require(CVodeSetLinearSolver(cvode.get(), linear_solver.get(), matrix.get()));
    require(CVodeSetJacFn(cvode.get(), jacobian));
    require(CVodeSetMaxNumSteps(cvode.get(), options.step_limit));
  }

  // Forgets the past of the solution; its memory stays.
  void start() {
    require(CVodeReInit(cvode.get(), 0.0, vector.get()));
    time = 0.0;
    fresh = false;
  }

  static int derivative(realtype, N_Vector state, N_Vector rate, void* self) {
    const auto& integrator = *static_cast<const Implementation*>(self);
    const Eigen::Index n = integrator.x.size();
    Map dx(N_VGetArrayPointer(rate), n);
    integrator.system->derivative(ConstMap(N_VGetArrayPointer(state), n), integrator.u, dx);
    return dx.allFinite() ? 0 : 1;  // 1: try a shorter step
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
  // In the order in which they depend on each other; x is the memory of `vector`.
  Context context;
  Vector vector;
  Matrix matrix;
  LinearSolver linear_solver;
  Cvode cvode;
};

OdeIntegrator::OdeIntegrator(std::shared_ptr<const OdeSystem> system, const OdeOptions& options) {
  if (!system)
    throw InputError("system to integrate", "none", "a system");
  options.validate();
  implementation_ = std::make_unique<Implementation>(std::move(system), options);
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
  if (my.fresh || changed)
    my.start();
  const double end = my.time + duration;
  require(CVodeSetStopTime(my.cvode.get(), end));
  const int flag = CVode(my.cvode.get(), end, my.vector.get(), &my.time, CV_NORMAL);
  if (flag >= 0)
    return OdeStatus::ok;
  return flag == CV_TOO_MUCH_WORK ? OdeStatus::step_limit : OdeStatus::failed;
}

const Eigen::VectorXd& OdeIntegrator::state() const {
  return implementation_->x;
}

}  // namespace mpm
