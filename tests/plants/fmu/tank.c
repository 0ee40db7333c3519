/* The quadruple tank of plants/nonlinear/quadruple_tank.hpp as an FMU (FMI 2.0, co-simulation), written from the standard: what a
 * modelling tool exports. Levels stay above 0.001 cm here, where the two have the same equations. It integrates by the
 * classical Runge-Kutta method in steps of kStep at most, and allows one instance a process, as many exports do. */

#define _GNU_SOURCE
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef void (*Logger)(void*, const char*, int, const char*, const char*, ...);
typedef struct {
  Logger logger;
  void* (*allocate)(size_t, size_t);
  void (*free)(void*);
  void (*step_finished)(void*, int);
  void* environment;
} Callbacks;

enum { kOk = 0, kDiscard = 2, kError = 3, kFatal = 4 };
enum { kTanks = 4, kInputs = 12, kParameters = 16, kFirstOutput = 100, kFirstParameter = 200 };
enum { kA = 0, kCd = 4, kExp = 8, kPump = 12, kOffset = 14, kFailure = 15 };

static const double kStep = 0.5; /* s: an error of 1e-11 cm at the time constants of these tanks */

typedef struct {
  Callbacks callbacks;
  double h[kTanks], u[kInputs], p[kParameters];
  int initialised;
} Tank;

static int instances = 0;

/* As modelDescription.xml has them. */
static const double kStart[kParameters] = {28,  32,  28,  32,  3.145, 2.525, 3.145, 2.525,
                                           0.5, 0.5, 0.5, 0.5, 3.14,  3.29,  0,     0};

/* As the environment has it: a version and types of others, and none. */
static const char* told(const char* variable, const char* usual) {
  const char* other = getenv(variable);
  return other == NULL ? usual : *other == 0 ? NULL : other;
}
const char* fmi2GetVersion(void) { return told("MPMBENCH_TANK_VERSION", "2.0"); }
const char* fmi2GetTypesPlatform(void) { return told("MPMBENCH_TANK_TYPES", "default"); }

void* fmi2Instantiate(const char* name, int type, const char* guid, const char* resources, const Callbacks* callbacks,
                      int visible, int logging) {
  (void)name, (void)visible, (void)logging;
  if (type != 1 || strcmp(guid, "{f3c0c5c4-5d1b-4a66-9b1c-0f6f6d1f2a7e}") != 0 || strncmp(resources, "file://", 7) != 0)
    return NULL;
  if (instances++ > 0) {
    callbacks->logger(callbacks->environment, name, kError, "error", "%d instances in one process", instances);
    return NULL;
  }
  Tank* tank = callbacks->allocate(1, sizeof(Tank));
  tank->callbacks = *callbacks;
  memcpy(tank->p, kStart, sizeof kStart);
  return tank;
}

static void derivative(const Tank* tank, const double* h, double* dh) {
  const double *u = tank->u, *p = tank->p;
  const double pumped[kTanks] = {u[2] * p[kPump] * u[0], u[3] * p[kPump + 1] * u[1], (1 - u[3]) * p[kPump + 1] * u[1],
                                 (1 - u[2]) * p[kPump] * u[0]};
  double out[kTanks];
  for (int i = 0; i < kTanks; ++i) {
    const double level = h[i] + u[8 + i];
    out[i] = level > 0 ? p[kCd + i] * pow(level, p[kExp + i]) : 0;
  }
  for (int i = 0; i < kTanks; ++i)
    dh[i] = ((i < 2 ? out[i + 2] : 0) - out[i] + pumped[i] + u[4 + i]) / p[kA + i];
}

static void integrate(Tank* tank, double step) {
  double k1[kTanks], k2[kTanks], k3[kTanks], k4[kTanks], h[kTanks];
  derivative(tank, tank->h, k1);
  for (int i = 0; i < kTanks; ++i) h[i] = tank->h[i] + step / 2 * k1[i];
  derivative(tank, h, k2);
  for (int i = 0; i < kTanks; ++i) h[i] = tank->h[i] + step / 2 * k2[i];
  derivative(tank, h, k3);
  for (int i = 0; i < kTanks; ++i) h[i] = tank->h[i] + step * k3[i];
  derivative(tank, h, k4);
  for (int i = 0; i < kTanks; ++i) tank->h[i] += step / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
}

int fmi2SetupExperiment(void* tank, int has_tolerance, double tolerance, double start, int has_stop, double stop) {
  (void)tank, (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
  return start == 0 ? kOk : kError;
}

/* Not where the tank rests: whoever uses it has to wait. */
int fmi2EnterInitializationMode(void* component) {
  Tank* tank = component;
  for (int i = 0; i < kTanks; ++i) tank->h[i] = 8;
  return kOk;
}
int fmi2ExitInitializationMode(void* component) {
  ((Tank*)component)->initialised = 1;
  return kOk;
}

/* The areas are fixed: they cannot change any more. */
int fmi2SetReal(void* component, const unsigned int* references, size_t count, const double* values) {
  Tank* tank = component;
  for (size_t i = 0; i < count; ++i) {
    const unsigned int r = references[i];
    if (r >= kFirstParameter && r < kFirstParameter + kParameters) {
      double* parameter = &tank->p[r - kFirstParameter];
      if (tank->initialised && r < kFirstParameter + kCd && *parameter != values[i]) return kError;
      *parameter = values[i];
    } else if (r < kInputs) {
      tank->u[r] = values[i];
    } else {
      return kError;
    }
  }
  return kOk;
}

int fmi2GetReal(void* component, const unsigned int* references, size_t count, double* values) {
  const Tank* tank = component;
  for (size_t i = 0; i < count; ++i) {
    const unsigned int tank_of = references[i] - kFirstOutput;
    if (tank_of >= kTanks) return kError;
    values[i] = tank->p[kFailure] == 6 ? NAN : tank->h[tank_of] + tank->u[8 + tank_of] + tank->p[kOffset];
  }
  return kOk;
}

/* What goes wrong in other people's programs, by the parameter `failure`. */
static int fail(const Tank* tank) {
  static char noise[4096];
  static int forked;
  switch ((int)tank->p[kFailure]) {
    case 1: {
      volatile int* nowhere = NULL;
      return *nowhere;
    }
    case 2:
      tank->callbacks.logger(tank->callbacks.environment, "tank", kError, "error", "tank %d is %s", 3, "empty");
      return kError;
    case 3:
      return kFatal;
    case 4:
      for (;;) pause();
    case 5:
      exit(3);
    case 7:
      return kDiscard;
    case 8: /* into whatever was inherited, for ever: more than anybody reads, and then as if it were an answer */
      for (;;)
        for (int file = 3; file < 100; ++file) write(file, memset(noise, 0x7f, sizeof noise), sizeof noise);
    case 9: /* answers that nobody asked for, without numbers, for ever */
      for (;;)
        for (int file = 3; file < 100; ++file) write(file, memset(noise, 0, sizeof noise), sizeof noise);
    case 10: /* a process that leaves its session and outlives everything */
    case 12: /* and then no answer */
      if (!forked++ && fork() == 0) {
        setsid();
        for (;;) pause();
      }
      if (tank->p[kFailure] == 12)
        for (;;) pause();
      return kOk;
    case 11: /* no connection, and no end */
      for (int file = 0; file < 100; ++file) close(file);
      for (;;) pause();
    case 13: /* nobody is to notice */
      kill(getppid(), SIGSTOP);
      for (;;) pause();
    default:
      return kOk;
  }
}

int fmi2DoStep(void* component, double now, double step, int no_earlier_state) {
  (void)now, (void)no_earlier_state;
  Tank* tank = component;
  const int status = fail(tank);
  if (status != kOk) return status;
  const int steps = (int)ceil(step / kStep);
  for (int i = 0; i < steps; ++i) integrate(tank, step / steps);
  return kOk;
}
