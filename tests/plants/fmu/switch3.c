/* x' = (u - x) / tau and y = x + d, by FMI 3.0 for model exchange, with every kind of event: when x passes 1 on its way
 * up, tau doubles (a root of an indicator); at the time 5 d becomes 10 (an event of time); after the first step of the
 * integrator beyond the time 8 d becomes 20 (a request). */

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

enum { kOk = 0, kError = 3 };

static struct {
  double time, x, u, tau, d;
  bool passed, asked, continuous;
} m = {0, 0, 2, 4, 0, false, false, false};

typedef void (*LogMessage)(void*, int, const char*, const char*);

const char* fmi3GetVersion(void) { return "3.0"; }
void* fmi3InstantiateModelExchange(const char* name, const char* token, const char* resources, bool visible, bool logging,
                                   void* environment, LogMessage log) {
  (void)name, (void)resources, (void)visible, (void)logging, (void)environment, (void)log;
  return strcmp(token, "{switch}") == 0 ? &m : NULL;
}
int fmi3EnterInitializationMode(void* i, bool has_tolerance, double tolerance, double start, bool has_stop, double stop) {
  (void)i, (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
  m.time = start;
  return kOk;
}
int fmi3ExitInitializationMode(void* i) { return (void)i, kOk; }
int fmi3EnterEventMode(void* i) {
  (void)i;
  if (!m.continuous) return kError;
  m.continuous = false;
  return kOk;
}
int fmi3EnterContinuousTimeMode(void* i) {
  (void)i;
  if (m.continuous) return kError;
  m.continuous = true;
  return kOk;
}
/* It takes a second iteration to see that nothing changes any more. */
int fmi3UpdateDiscreteStates(void* i, bool* again, bool* terminate, bool* nominals, bool* states, bool* has_next,
                             double* next) {
  (void)i;
  if (m.continuous) return kError;
  *again = *terminate = *nominals = *states = false;
  if (!m.passed && m.x >= 1) {
    m.passed = *again = true;
    m.tau *= 2;
  }
  if (m.d == 0 && m.time >= 5) {
    m.d = 10;
    *again = true;
  }
  if (m.asked && m.d == 10) {
    m.d = 20;
    *again = true;
  }
  *has_next = m.time < 5;
  *next = 5;
  return kOk;
}
int fmi3CompletedIntegratorStep(void* i, bool no_earlier_state, bool* enter_event_mode, bool* terminate) {
  (void)i, (void)no_earlier_state;
  *terminate = false;
  *enter_event_mode = !m.asked && m.time > 8;
  m.asked = m.asked || *enter_event_mode;
  return kOk;
}
int fmi3SetTime(void* i, double time) { return (void)i, m.time = time, kOk; }
int fmi3SetContinuousStates(void* i, const double* x, size_t n) { return (void)i, (void)n, m.x = x[0], kOk; }
int fmi3GetContinuousStates(void* i, double* x, size_t n) { return (void)i, (void)n, x[0] = m.x, kOk; }
int fmi3GetNominalsOfContinuousStates(void* i, double* x, size_t n) { return (void)i, (void)n, x[0] = 1, kOk; }
int fmi3GetContinuousStateDerivatives(void* i, double* dx, size_t n) {
  return (void)i, (void)n, dx[0] = (m.u - m.x) / m.tau, kOk;
}
int fmi3GetEventIndicators(void* i, double* z, size_t n) { return (void)i, (void)n, z[0] = m.x - 1, kOk; }
int fmi3GetNumberOfContinuousStates(void* i, size_t* n) { return (void)i, *n = 1, kOk; }
int fmi3GetNumberOfEventIndicators(void* i, size_t* n) { return (void)i, *n = 1, kOk; }
int fmi3SetFloat64(void* i, const uint32_t* references, size_t n, const double* values, size_t value_count) {
  (void)i, (void)value_count;
  if (n != 1 || references[0] != 1 || m.continuous) return kError;
  m.u = values[0];
  return kOk;
}
int fmi3GetFloat64(void* i, const uint32_t* references, size_t n, double* values, size_t value_count) {
  (void)i, (void)references, (void)n, (void)value_count;
  values[0] = m.x + m.d;
  return kOk;
}
