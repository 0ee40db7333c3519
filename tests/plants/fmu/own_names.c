/* y' = (u - y) / 10 as an FMU (FMI 2.0, co-simulation) that brings an integrator and a solver under the names of CVODE and
 * LAPACK, as exports of some tools do: it works only if these are the ones that it calls. It makes steps of 2 s at most,
 * ends where its experiment does, at 10 s unless it is told, and gives its logger no environment. */

#include <math.h>
#include <stddef.h>

typedef void (*Logger)(void*, const char*, int, const char*, const char*, ...);
typedef struct {
  Logger logger;
  void* (*allocate)(size_t, size_t);
  void (*free)(void*);
  void (*step_finished)(void*, int);
  void* environment;
} Callbacks;

enum { kOk = 0, kDiscard = 2, kError = 3 };

static double values[3];
static double stop = 10;
static Logger logger;
static int logging;

double dgetrf_(double gain) { return gain / 10; }
double CVode(double y, double u, double step) { return u + (y - u) * exp(-dgetrf_(1) * step); }

const char* fmi2GetVersion(void) { return "2.0"; }
const char* fmi2GetTypesPlatform(void) { return "default"; }

void* fmi2Instantiate(const char* name, int type, const char* guid, const char* resources, const Callbacks* callbacks,
                      int visible, int with_logging) {
  (void)name, (void)type, (void)guid, (void)resources, (void)visible;
  logger = callbacks->logger;
  logging = with_logging;
  return values;
}

int fmi2SetupExperiment(void* lag, int has_tolerance, double tolerance, double start, int has_stop, double stop_time) {
  (void)lag, (void)has_tolerance, (void)tolerance, (void)start;
  if (has_stop) stop = stop_time;
  return kOk;
}
int fmi2EnterInitializationMode(void* lag) { return lag == values ? kOk : kError; }
int fmi2ExitInitializationMode(void* lag) { return lag == values ? kOk : kError; }

int fmi2SetReal(void* lag, const unsigned int* references, size_t count, const double* given) {
  for (size_t i = 0; i < count; ++i) ((double*)lag)[references[i]] = given[i];
  return kOk;
}
int fmi2GetReal(void* lag, const unsigned int* references, size_t count, double* taken) {
  for (size_t i = 0; i < count; ++i) taken[i] = ((double*)lag)[references[i]];
  return kOk;
}

int fmi2DoStep(void* lag, double now, double step, int no_earlier_state) {
  (void)lag, (void)no_earlier_state;
  if (values[2] == 1) {
    if (logging) logger(NULL, "lag", kError, "logStatusError", "no %s in the lag", "water");
    return kError;
  }
  if (now + step > stop || step > 2.0000001) return kDiscard;
  values[1] = CVode(values[1], values[0], step);
  return kOk;
}
