/* The tank of tank.c by FMI 3.0 (co-simulation), written from the standard. It handles no events and returns when its
 * step is done; by the parameter `failure` it asks to end (20) or returns early (21) all the same. */

#include "tank.c"

#include <stdbool.h>
#include <stdint.h>

typedef void (*LogMessage)(void*, int, const char*, const char*);

static LogMessage log_message;
static void* environment;

/* The logger of FMI 2.0, with the text that it would have made. */
static void log3(void* unused, const char* name, int status, const char* category, const char* message, ...) {
  (void)unused, (void)name;
  if (strcmp(message, "tank %d is %s") == 0) message = "tank 3 is empty";
  log_message(environment, status, category, message);
}

const char* fmi3GetVersion(void) { return "3.0"; }

void* fmi3InstantiateCoSimulation(const char* name, const char* token, const char* resources, bool visible, bool logging,
                                  bool events, bool early_return, const uint32_t* intermediate, size_t intermediate_count,
                                  void* of_caller, LogMessage log, void* update) {
  const Callbacks callbacks = {log3, calloc, free, NULL, NULL};
  const size_t length = strlen(resources);
  if (visible || !logging || events || early_return || intermediate != NULL || intermediate_count != 0 || update != NULL ||
      resources[0] != '/' || resources[length - 1] != '/')
    return NULL;
  log_message = log;
  environment = of_caller;
  return fmi2Instantiate(name, 1, token, "file://", &callbacks, 0, 1);
}

int fmi3EnterInitializationMode(void* tank, bool has_tolerance, double tolerance, double start, bool has_stop, double stop) {
  (void)has_tolerance, (void)tolerance;
  if (start != 0 || !has_stop || stop < 1e6) return kError;
  return fmi2EnterInitializationMode(tank);
}
int fmi3ExitInitializationMode(void* tank) { return fmi2ExitInitializationMode(tank); }

int fmi3SetFloat64(void* tank, const uint32_t* references, size_t count, const double* values, size_t value_count) {
  return count == value_count ? fmi2SetReal(tank, references, count, values) : kError;
}
int fmi3GetFloat64(void* tank, const uint32_t* references, size_t count, double* values, size_t value_count) {
  return count == value_count ? fmi2GetReal(tank, references, count, values) : kError;
}

int fmi3DoStep(void* component, double now, double step, bool no_earlier_state, bool* events_needed, bool* terminate,
               bool* early_return, double* reached) {
  const int failure = (int)((Tank*)component)->p[kFailure];
  *events_needed = false;
  *terminate = failure == 20;
  *early_return = failure == 21;
  *reached = failure == 21 ? now : now + step;
  return fmi2DoStep(component, now, step, no_earlier_state);
}
