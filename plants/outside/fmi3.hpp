#pragma once

#include <cstddef>

/// The part of the C interface of FMI 3.0 that mpmbench uses: the types and the signatures of the functions
/// as the standard gives them (Functional Mock-up Interface Specification, version 3.0, chapters 2 to 4). The
/// function NAME is `fmi3NAME` in the library of an FMU.
namespace mpm::fmi3 {

using Instance = void*;
using InstanceEnvironment = void*;  ///< what is passed back to the logger
using ValueReference = unsigned int;
using Float64 = double;
using Boolean = bool;
using String = const char*;

enum Status : int { ok, warning, discard, error, fatal };

inline constexpr const char* kVersion = "3.0";

using LogMessage = void(InstanceEnvironment, Status, String category, String message);
using IntermediateUpdate = void(InstanceEnvironment, Float64 time, Boolean set_inputs, Boolean get_outputs,
                                Boolean step_finished, Boolean early_return_allowed, Boolean* early_return,
                                Float64* early_return_time);

using GetVersion = String();
using InstantiateCoSimulation = Instance(String name, String token, String resources, Boolean visible,
                                         Boolean logging, Boolean events, Boolean early_return,
                                         const ValueReference* intermediate, std::size_t intermediate_count,
                                         InstanceEnvironment, LogMessage*, IntermediateUpdate*);
using EnterInitializationMode = Status(Instance, Boolean has_tolerance, Float64 tolerance, Float64 start,
                                       Boolean has_stop, Float64 stop);
using ExitInitializationMode = Status(Instance);
using SetFloat64 = Status(Instance, const ValueReference*, std::size_t count, const Float64*,
                          std::size_t value_count);
using GetFloat64 = Status(Instance, const ValueReference*, std::size_t count, Float64*,
                          std::size_t value_count);
using DoStep = Status(Instance, Float64 now, Float64 step, Boolean no_earlier_state, Boolean* events_needed,
                      Boolean* terminate, Boolean* early_return, Float64* reached);

// For model exchange; functions that have the same name in both versions are in fmu_model_exchange.hpp.
using InstantiateModelExchange = Instance(String name, String token, String resources, Boolean visible,
                                          Boolean logging, InstanceEnvironment, LogMessage*);
using UpdateDiscreteStates = Status(Instance, Boolean* again, Boolean* terminate, Boolean* nominals_changed,
                                    Boolean* states_changed, Boolean* has_next_event, Float64* next_event);
/// The signature of GetNumberOfContinuousStates and GetNumberOfEventIndicators.
using GetNumber = Status(Instance, std::size_t*);

}  // namespace mpm::fmi3
