#pragma once

#include <memory>
#include <new>
#include <type_traits>

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

/// Owners of SUNDIALS objects. With right sizes and pointers, SUNDIALS fails only for lack of memory.
namespace mpm::sundials {

/// The deleter of a handle that SUNDIALS frees by its value, or by its address.
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

using SunContext = std::unique_ptr<std::remove_pointer_t<SUNContext>, FreeBy<SUNContext_Free>>;
using SunVector = std::unique_ptr<std::remove_pointer_t<N_Vector>, FreeBy<N_VDestroy>>;
using SunMatrix = std::unique_ptr<std::remove_pointer_t<SUNMatrix>, FreeBy<SUNMatDestroy>>;
using SunLinearSolver = std::unique_ptr<std::remove_pointer_t<SUNLinearSolver>, FreeBy<SUNLinSolFree>>;
using Cvode = std::unique_ptr<void, FreeBy<CVodeFree>>;

template <class Handle>
Handle checked(Handle handle) {
  if (!handle)
    throw std::bad_alloc();
  return handle;
}

inline void require(int flag) {
  if (flag != 0)
    throw std::bad_alloc();
}

inline SunContext make_context() {
  SUNContext context = nullptr;
  require(SUNContext_Create(nullptr, &context));
  return SunContext(context);
}

/// An error handler that prints nothing: the status tells the outcome.
inline void say_nothing(int, const char*, const char*, char*, void*) {}

}  // namespace mpm::sundials
