#pragma once

#include <cstddef>

/// The part of the C interface of FMI 2.0 that mpmbench uses: the types and the signatures of the functions
/// as the standard gives them (FMI for Model Exchange and Co-Simulation, version 2.0, 2.1, 3.2 and 4.2). The
/// function NAME is `fmi2NAME` in the library of an FMU.
namespace mpm::fmi2 {

using Component = void*;             ///< an instance
using ComponentEnvironment = void*;  ///< what is passed back to the logger
using ValueReference = unsigned int;
using Real = double;
using Boolean = int;
using String = const char*;

enum Status : int { ok, warning, discard, error, fatal, pending };
enum Type : int { model_exchange, co_simulation };

inline constexpr Boolean kFalse = 0, kTrue = 1;
inline constexpr const char* kVersion = "2.0";
inline constexpr const char* kTypesPlatform = "default";

using Logger = void(ComponentEnvironment, String instance, Status, String category, String message, ...);

struct CallbackFunctions {
  Logger* logger;
  void* (*allocate)(std::size_t count, std::size_t size);
  void (*free)(void*);
  void (*step_finished)(ComponentEnvironment, Status);
  ComponentEnvironment environment;
};

using GetTypesPlatform = String();
using GetVersion = String();
using Instantiate = Component(String name, Type, String guid, String resources, const CallbackFunctions*,
                              Boolean visible, Boolean logging);
using SetupExperiment = Status(Component, Boolean has_tolerance, Real tolerance, Real start, Boolean has_stop,
                               Real stop);
using EnterInitializationMode = Status(Component);
using ExitInitializationMode = Status(Component);
using SetReal = Status(Component, const ValueReference*, std::size_t count, const Real*);
using GetReal = Status(Component, const ValueReference*, std::size_t count, Real*);
using DoStep = Status(Component, Real now, Real step, Boolean no_earlier_state);

// For model exchange; functions that have the same name in both versions are in fmu_model_exchange.hpp.
/// The outcome of one iteration of the discrete states.
struct EventInfo {
  Boolean again, terminate, nominals_changed, states_changed, has_next_event;
  Real next_event;
};
using NewDiscreteStates = Status(Component, EventInfo*);

}  // namespace mpm::fmi2
