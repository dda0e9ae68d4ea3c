/* A force table as an FMU for co-simulation, FMI 3.0: inputs depth and speed, outputs force, slope
 * and pull-off force. The outputs are functions of the inputs; the time does not matter.
 * Types and functions are those of the standard, https://fmi-standard.org/docs/3.0/. */
#include "$name.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#if defined _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

typedef enum { OK, WARNING, DISCARD, ERROR, FATAL } Status;
typedef uint32_t Reference;
typedef void (*Log)(void *, Status, const char *, const char *);
typedef struct {
  double value[6]; /* by reference: time, depth, speed, force, slope, pull-off force */
  Log log;
  void *environment;
} Instance;

enum { TIME, DEPTH, SPEED, FORCE, SLOPE, PULL_OFF };

static void evaluate(Instance *it) {
  double *x = it->value;
  ${name}_force(x[DEPTH], x[SPEED], &x[FORCE], &x[SLOPE]);
  x[PULL_OFF] = ${name}_pull_off_force(x[SPEED]);
}

static Status refused(void *instance, const char *words) {
  Instance *it = instance;
  if (it && it->log) it->log(it->environment, ERROR, "logStatusError", words);
  return ERROR;
}

static void initial(Instance *it) {
  memset(it->value, 0, sizeof it->value);
  it->value[DEPTH] = ${name}_start_depth;
  it->value[SPEED] = ${name}_speed[0];
}

EXPORT const char *fmi3GetVersion(void) { return "3.0"; }
EXPORT Status fmi3SetDebugLogging(void *i, bool on, size_t n, const char *const c[]) {
  (void)i, (void)on, (void)n, (void)c;
  return OK;
}
EXPORT void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources,
                                         bool visible, bool logging, bool events, bool early,
                                         const Reference required[], size_t n, void *environment,
                                         Log log, void *intermediate) {
  Instance *it;
  (void)name, (void)resources, (void)visible, (void)events, (void)early, (void)required, (void)n;
  (void)intermediate;
  if (!token || strcmp(token, "$token")) {
    if (log) log(environment, ERROR, "logStatusError", "the token is that of another model");
    return NULL;
  }
  if (!(it = calloc(1, sizeof *it))) return NULL;
  it->log = logging ? log : NULL;
  it->environment = environment;
  initial(it);
  return it;
}
EXPORT void *fmi3InstantiateModelExchange(const char *a, const char *b, const char *c, bool d, bool e,
                                          void *f, Log g) {
  (void)a, (void)b, (void)c, (void)d, (void)e, (void)f, (void)g;
  return NULL;
}
EXPORT void *fmi3InstantiateScheduledExecution(const char *a, const char *b, const char *c, bool d,
                                               bool e, void *f, Log g, void *h, void *i, void *j) {
  (void)a, (void)b, (void)c, (void)d, (void)e, (void)f, (void)g, (void)h, (void)i, (void)j;
  return NULL;
}
EXPORT void fmi3FreeInstance(void *i) { free(i); }

/* Modes: none changes anything. */
EXPORT Status fmi3EnterInitializationMode(void *i, bool tolerates, double tolerance, double start,
                                          bool ends, double stop) {
  (void)tolerates, (void)tolerance, (void)ends, (void)stop;
  ((Instance *)i)->value[TIME] = start;
  return OK;
}
EXPORT Status fmi3ExitInitializationMode(void *i) { return i ? OK : ERROR; }
EXPORT Status fmi3EnterEventMode(void *i) { return i ? OK : ERROR; }
EXPORT Status fmi3EnterStepMode(void *i) { return i ? OK : ERROR; }
EXPORT Status fmi3EnterConfigurationMode(void *i) { return i ? OK : ERROR; }
EXPORT Status fmi3ExitConfigurationMode(void *i) { return i ? OK : ERROR; }
EXPORT Status fmi3Terminate(void *i) { return i ? OK : ERROR; }
EXPORT Status fmi3Reset(void *i) {
  initial(i);
  return OK;
}

EXPORT Status fmi3GetFloat64(void *i, const Reference which[], size_t n, double values[], size_t m) {
  size_t k;
  if (m != n) return refused(i, "as many values as references are needed");
  evaluate(i);
  for (k = 0; k < n; k++) {
    if (which[k] > PULL_OFF) return refused(i, "unknown variable");
    values[k] = ((Instance *)i)->value[which[k]];
  }
  return OK;
}
EXPORT Status fmi3SetFloat64(void *i, const Reference which[], size_t n, const double values[],
                             size_t m) {
  size_t k;
  if (m != n) return refused(i, "as many values as references are needed");
  for (k = 0; k < n; k++) {
    if (which[k] != DEPTH && which[k] != SPEED) return refused(i, "only inputs can be set");
    ((Instance *)i)->value[which[k]] = values[k];
  }
  return OK;
}
EXPORT Status fmi3DoStep(void *i, double now, double step, bool final, bool *event, bool *stop,
                         bool *early, double *last) {
  (void)final;
  ((Instance *)i)->value[TIME] = *last = now + step;
  *event = *stop = *early = false;
  return OK;
}
EXPORT Status fmi3GetOutputDerivatives(void *i, const Reference w[], size_t n, const int32_t orders[],
                                       double values[], size_t m) {
  (void)w, (void)n, (void)orders, (void)values, (void)m;
  return refused(i, "outputs have no derivatives by the time");
}

/* The model has variables of no other type. */
#define NO_TYPE(kind, type)                                                                        \
  EXPORT Status fmi3Get##kind(void *i, const Reference w[], size_t n, type v[], size_t m) {        \
    (void)w, (void)v, (void)m;                                                                     \
    return n ? refused(i, "no variable of this type") : OK;                                        \
  }                                                                                                \
  EXPORT Status fmi3Set##kind(void *i, const Reference w[], size_t n, const type v[], size_t m) {  \
    (void)w, (void)v, (void)m;                                                                     \
    return n ? refused(i, "no variable of this type") : OK;                                        \
  }
typedef const char *Text;
NO_TYPE(Float32, float)
NO_TYPE(Int8, int8_t)
NO_TYPE(UInt8, uint8_t)
NO_TYPE(Int16, int16_t)
NO_TYPE(UInt16, uint16_t)
NO_TYPE(Int32, int32_t)
NO_TYPE(UInt32, uint32_t)
NO_TYPE(Int64, int64_t)
NO_TYPE(UInt64, uint64_t)
NO_TYPE(Boolean, bool)
NO_TYPE(String, Text)
EXPORT Status fmi3GetBinary(void *i, const Reference w[], size_t n, size_t s[], const uint8_t *v[],
                            size_t m) {
  (void)w, (void)s, (void)v, (void)m;
  return n ? refused(i, "no variable of this type") : OK;
}
EXPORT Status fmi3SetBinary(void *i, const Reference w[], size_t n, const size_t s[],
                            const uint8_t *const v[], size_t m) {
  (void)w, (void)s, (void)v, (void)m;
  return n ? refused(i, "no variable of this type") : OK;
}
EXPORT Status fmi3GetClock(void *i, const Reference w[], size_t n, bool v[]) {
  (void)w, (void)v;
  return n ? refused(i, "no variable of this type") : OK;
}
EXPORT Status fmi3SetClock(void *i, const Reference w[], size_t n, const bool v[]) {
  (void)w, (void)v;
  return n ? refused(i, "no variable of this type") : OK;
}

/* Abilities that the model description does not state. */
#define NOT_ABLE(name, ...)                                                                        \
  EXPORT Status name(void *i, __VA_ARGS__) { return refused(i, #name " is not provided"); }
NOT_ABLE(fmi3GetNumberOfVariableDependencies, Reference w, size_t *n)
NOT_ABLE(fmi3GetVariableDependencies, Reference w, size_t a[], Reference b[], size_t c[], int d[],
         size_t n)
NOT_ABLE(fmi3GetFMUState, void **s)
NOT_ABLE(fmi3SetFMUState, void *s)
NOT_ABLE(fmi3FreeFMUState, void **s)
NOT_ABLE(fmi3SerializedFMUStateSize, void *s, size_t *n)
NOT_ABLE(fmi3SerializeFMUState, void *s, uint8_t b[], size_t n)
NOT_ABLE(fmi3DeserializeFMUState, const uint8_t b[], size_t n, void **s)
NOT_ABLE(fmi3GetDirectionalDerivative, const Reference u[], size_t n, const Reference k[], size_t m,
         const double s[], size_t a, double r[], size_t b)
NOT_ABLE(fmi3GetAdjointDerivative, const Reference u[], size_t n, const Reference k[], size_t m,
         const double s[], size_t a, double r[], size_t b)
NOT_ABLE(fmi3GetIntervalDecimal, const Reference w[], size_t n, double v[], int q[])
NOT_ABLE(fmi3GetIntervalFraction, const Reference w[], size_t n, uint64_t c[], uint64_t r[], int q[])
NOT_ABLE(fmi3GetShiftDecimal, const Reference w[], size_t n, double v[])
NOT_ABLE(fmi3GetShiftFraction, const Reference w[], size_t n, uint64_t c[], uint64_t r[])
NOT_ABLE(fmi3SetIntervalDecimal, const Reference w[], size_t n, const double v[])
NOT_ABLE(fmi3SetIntervalFraction, const Reference w[], size_t n, const uint64_t c[],
         const uint64_t r[])
NOT_ABLE(fmi3SetShiftDecimal, const Reference w[], size_t n, const double v[])
NOT_ABLE(fmi3SetShiftFraction, const Reference w[], size_t n, const uint64_t c[], const uint64_t r[])
/* Functions of the other two kinds of FMU, for tools that look for all of them. */
EXPORT Status fmi3EnterContinuousTimeMode(void *i) { return refused(i, "the time does not matter"); }
NOT_ABLE(fmi3CompletedIntegratorStep, bool a, bool *b, bool *c)
NOT_ABLE(fmi3SetTime, double time)
NOT_ABLE(fmi3SetContinuousStates, const double x[], size_t n)
NOT_ABLE(fmi3GetContinuousStateDerivatives, double x[], size_t n)
NOT_ABLE(fmi3GetEventIndicators, double x[], size_t n)
NOT_ABLE(fmi3GetContinuousStates, double x[], size_t n)
NOT_ABLE(fmi3GetNominalsOfContinuousStates, double x[], size_t n)
NOT_ABLE(fmi3GetNumberOfEventIndicators, size_t *n)
NOT_ABLE(fmi3GetNumberOfContinuousStates, size_t *n)
NOT_ABLE(fmi3ActivateModelPartition, Reference clock, double time)
EXPORT Status fmi3EvaluateDiscreteStates(void *i) { return i ? OK : ERROR; }
EXPORT Status fmi3UpdateDiscreteStates(void *i, bool *discrete, bool *stop, bool *nominal,
                                       bool *states, bool *event, double *next) {
  (void)next;
  *discrete = *stop = *nominal = *states = *event = false;
  return i ? OK : ERROR;
}
