/* The tank of tank.c by FMI 2.0 for model exchange, written from the standard: the equations alone, without events. Of
 * the order of calls it allows what the standard does. */

#define fmi2Instantiate instantiate_co_simulation
#define fmi2SetReal set_real
#include "tank.c"
#undef fmi2Instantiate
#undef fmi2SetReal

enum Mode { kInitializing, kEvent, kContinuous };
static enum Mode mode;

typedef struct {
  int again, terminate, nominals_changed, states_changed, has_next_event;
  double next_event;
} EventInfo;

void* fmi2Instantiate(const char* name, int type, const char* guid, const char* resources, const Callbacks* callbacks,
                      int visible, int logging) {
  return type == 0 ? instantiate_co_simulation(name, 1, guid, resources, callbacks, visible, logging) : NULL;
}

/* Parameters and inputs jump, which they may in the event mode only. */
int fmi2SetReal(void* tank, const unsigned int* references, size_t count, const double* values) {
  return mode == kContinuous ? kError : set_real(tank, references, count, values);
}

int fmi2NewDiscreteStates(void* tank, EventInfo* info) {
  (void)tank;
  if (mode == kContinuous) return kError;
  mode = kEvent;
  *info = (EventInfo){0, ((Tank*)tank)->p[kFailure] == 20, 0, 0, 0, 0};
  return kOk;
}
int fmi2EnterEventMode(void* tank) {
  (void)tank;
  if (mode != kContinuous) return kError;
  mode = kEvent;
  return kOk;
}
int fmi2EnterContinuousTimeMode(void* tank) {
  (void)tank;
  if (mode != kEvent) return kError;
  mode = kContinuous;
  return kOk;
}
int fmi2CompletedIntegratorStep(void* tank, int no_earlier_state, int* enter_event_mode, int* terminate) {
  (void)tank, (void)no_earlier_state;
  *enter_event_mode = *terminate = 0;
  return mode == kContinuous ? kOk : kError;
}
int fmi2SetTime(void* tank, double time) {
  (void)tank, (void)time;
  return mode == kContinuous ? kOk : kError;
}
int fmi2SetContinuousStates(void* tank, const double* x, size_t count) {
  if (count != kTanks || mode != kContinuous) return kError;
  memcpy(((Tank*)tank)->h, x, sizeof ((Tank*)tank)->h);
  return kOk;
}
int fmi2GetContinuousStates(void* tank, double* x, size_t count) {
  if (count != kTanks) return kError;
  memcpy(x, ((Tank*)tank)->h, sizeof ((Tank*)tank)->h);
  return kOk;
}
int fmi2GetNominalsOfContinuousStates(void* tank, double* x, size_t count) {
  (void)tank;
  for (size_t i = 0; i < count; ++i) x[i] = 10;
  return kOk;
}
int fmi2GetDerivatives(void* tank, double* dx, size_t count) {
  const int status = count == kTanks && mode == kContinuous ? fail(tank) : kError;
  if (status == kOk) derivative(tank, ((Tank*)tank)->h, dx);
  return status;
}
int fmi2GetEventIndicators(void* tank, double* z, size_t count) {
  (void)tank, (void)z;
  return count == 0 ? kOk : kError;
}
