/* The functions of FMI 3.0 for co-simulation (Modelica Association 2022, FMI 3.0.2) around law and effects. The friction after a step is
 * that of the inputs as they stood at its start; effects remember what they have seen, a step at a time. */

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef void *Unit;
typedef void *Environment;
typedef uint32_t Reference;
typedef enum { OK, WARNING, DISCARD, ERROR, FATAL } Status;

/* Values as they are numbered in the description: the time, the outputs, the inputs. */
enum { TIME = 0, FIRST_OUTPUT = 1, FIRST_INPUT = 3 };

typedef struct {
    double time;
    double input[INPUTS];
    double output[OUTPUTS];
    Memory memory;
} Instance;

#ifdef FMI3_FUNCTION_PREFIX
#define JOINED(prefix, name) prefix##name
#define PREFIXED(prefix, name) JOINED(prefix, name)
#define FMI(name) PREFIXED(FMI3_FUNCTION_PREFIX, name)
#else
#define FMI(name) name
#endif
#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#elif defined(__GNUC__)
#define EXPORT __attribute__((visibility("default")))
#else
#define EXPORT
#endif

/* Declares and opens a function. */
#define FUNCTION(type, name, parameters) \
    EXPORT type FMI(name) parameters; \
    EXPORT type FMI(name) parameters

FUNCTION(const char *, fmi3GetVersion, (void)) { return "3.0"; }

FUNCTION(Unit, fmi3InstantiateCoSimulation,
         (const char *name, const char *token, const char *resources, bool visible, bool logs, bool events, bool early_return,
          const Reference required[], size_t requireds, Environment environment, void *log, void *update)) {
    (void)name, (void)resources, (void)visible, (void)logs, (void)events, (void)early_return;
    (void)required, (void)requireds, (void)environment, (void)log, (void)update;
    if (token == NULL || strcmp(token, TOKEN) != 0) {
        return NULL;
    }
    return calloc(1, sizeof(Instance));
}

FUNCTION(void, fmi3FreeInstance, (Unit unit)) { free(unit); }

FUNCTION(Status, fmi3Reset, (Unit unit)) {
    memset(unit, 0, sizeof(Instance));
    return OK;
}

FUNCTION(Status, fmi3EnterInitializationMode,
         (Unit unit, bool has_tolerance, double tolerance, double start, bool has_stop, double stop)) {
    Instance *instance = unit;
    (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
    instance->time = start;
    return OK;
}

FUNCTION(Status, fmi3ExitInitializationMode, (Unit unit)) {
    Instance *instance = unit;
    begin(instance->input, instance->output);
    return OK;
}

FUNCTION(Status, fmi3DoStep,
         (Unit unit, double now, double step, bool no_state_before, bool *event, bool *terminates, bool *early, double *reached)) {
    Instance *instance = unit;
    (void)no_state_before;
    *event = *terminates = *early = false;
    *reached = now;
    /* One step of the effects, as the drive makes it: not for a period that is none. */
    if (!(step > 0.0 && step <= 1.0)) {
        return ERROR;
    }
    advance(&instance->memory, (float)step, instance->input, instance->output);
    instance->time = *reached = now + step;
    return OK;
}

FUNCTION(Status, fmi3SetFloat64, (Unit unit, const Reference at[], size_t count, const double values[], size_t value_count)) {
    Instance *instance = unit;
    size_t i;
    if (value_count != count) {
        return ERROR;
    }
    for (i = 0; i < count; i++) {
        if (at[i] < FIRST_INPUT || at[i] >= FIRST_INPUT + INPUTS) {
            return ERROR;
        }
        instance->input[at[i] - FIRST_INPUT] = values[i];
    }
    return OK;
}

FUNCTION(Status, fmi3GetFloat64, (Unit unit, const Reference at[], size_t count, double values[], size_t value_count)) {
    const Instance *instance = unit;
    size_t i;
    if (value_count != count) {
        return ERROR;
    }
    for (i = 0; i < count; i++) {
        if (at[i] == TIME) {
            values[i] = instance->time;
        } else if (at[i] >= FIRST_OUTPUT && at[i] < FIRST_OUTPUT + OUTPUTS) {
            values[i] = instance->output[at[i] - FIRST_OUTPUT];
        } else if (at[i] >= FIRST_INPUT && at[i] < FIRST_INPUT + INPUTS) {
            values[i] = instance->input[at[i] - FIRST_INPUT];
        } else {
            return ERROR;
        }
    }
    return OK;
}

/* Copies an instance to a state, into new memory where it has none. */
static Status keep(void **state, const void *instance) {
    if (*state == NULL) {
        *state = malloc(sizeof(Instance));
    }
    if (*state == NULL) {
        return ERROR;
    }
    memcpy(*state, instance, sizeof(Instance));
    return OK;
}

FUNCTION(Status, fmi3GetFMUState, (Unit unit, void **state)) { return keep(state, unit); }

FUNCTION(Status, fmi3SetFMUState, (Unit unit, void *state)) {
    if (state == NULL) {
        return ERROR;
    }
    memcpy(unit, state, sizeof(Instance));
    return OK;
}

FUNCTION(Status, fmi3FreeFMUState, (Unit unit, void **state)) {
    (void)unit;
    free(*state);
    *state = NULL;
    return OK;
}

FUNCTION(Status, fmi3SerializedFMUStateSize, (Unit unit, void *state, size_t *size)) {
    (void)unit, (void)state;
    *size = sizeof(Instance);
    return OK;
}

FUNCTION(Status, fmi3SerializeFMUState, (Unit unit, void *state, uint8_t bytes[], size_t size)) {
    (void)unit;
    if (size < sizeof(Instance)) {
        return ERROR;
    }
    memcpy(bytes, state, sizeof(Instance));
    return OK;
}

FUNCTION(Status, fmi3DeserializeFMUState, (Unit unit, const uint8_t bytes[], size_t size, void **state)) {
    (void)unit;
    return size < sizeof(Instance) ? ERROR : keep(state, bytes);
}

/* What has nothing to do. */
#define NOTHING(name, parameters, unused) \
    FUNCTION(Status, name, parameters) { unused; return OK; }

NOTHING(fmi3Terminate, (Unit u), (void)u)
NOTHING(fmi3EnterConfigurationMode, (Unit u), (void)u)
NOTHING(fmi3ExitConfigurationMode, (Unit u), (void)u)
NOTHING(fmi3EnterStepMode, (Unit u), (void)u)
NOTHING(fmi3SetDebugLogging, (Unit u, bool on, size_t n, const char *const categories[]), ((void)u, (void)on, (void)n, (void)categories))

/* What the unit has not: variables of other kinds, events, clocks, derivatives, the interfaces for model exchange and scheduled execution. */
#define REFUSED(name, parameters, unused) \
    FUNCTION(Status, name, parameters) { unused; return ERROR; }
#define NO_VALUES(kind, type) \
    FUNCTION(Status, fmi3Get##kind, (Unit u, const Reference at[], size_t n, type values[], size_t value_count)) { \
        (void)u, (void)at, (void)values, (void)value_count; \
        return n == 0 ? OK : ERROR; \
    } \
    FUNCTION(Status, fmi3Set##kind, (Unit u, const Reference at[], size_t n, const type values[], size_t value_count)) { \
        (void)u, (void)at, (void)values, (void)value_count; \
        return n == 0 ? OK : ERROR; \
    }
typedef const char *String;
NO_VALUES(Float32, float)
NO_VALUES(Int8, int8_t)
NO_VALUES(UInt8, uint8_t)
NO_VALUES(Int16, int16_t)
NO_VALUES(UInt16, uint16_t)
NO_VALUES(Int32, int32_t)
NO_VALUES(UInt32, uint32_t)
NO_VALUES(Int64, int64_t)
NO_VALUES(UInt64, uint64_t)
NO_VALUES(Boolean, bool)
NO_VALUES(String, String)

typedef const uint8_t *Binary;
REFUSED(fmi3GetBinary, (Unit u, const Reference at[], size_t n, size_t sizes[], Binary values[], size_t count),
        ((void)u, (void)at, (void)n, (void)sizes, (void)values, (void)count))
REFUSED(fmi3SetBinary, (Unit u, const Reference at[], size_t n, const size_t sizes[], const Binary values[], size_t count),
        ((void)u, (void)at, (void)n, (void)sizes, (void)values, (void)count))
REFUSED(fmi3GetClock, (Unit u, const Reference at[], size_t n, bool values[]), ((void)u, (void)at, (void)n, (void)values))
REFUSED(fmi3SetClock, (Unit u, const Reference at[], size_t n, const bool values[]), ((void)u, (void)at, (void)n, (void)values))
REFUSED(fmi3GetNumberOfVariableDependencies, (Unit u, Reference at, size_t *n), ((void)u, (void)at, (void)n))
REFUSED(fmi3GetVariableDependencies,
        (Unit u, Reference at, size_t a[], Reference b[], size_t c[], int kinds[], size_t n),
        ((void)u, (void)at, (void)a, (void)b, (void)c, (void)kinds, (void)n))
#define OF_DERIVATIVES \
    (Unit u, const Reference a[], size_t n, const Reference b[], size_t m, const double seed[], size_t k, double result[], size_t l)
#define NO_DERIVATIVES ((void)u, (void)a, (void)n, (void)b, (void)m, (void)seed, (void)k, (void)result, (void)l)
REFUSED(fmi3GetDirectionalDerivative, OF_DERIVATIVES, NO_DERIVATIVES)
REFUSED(fmi3GetAdjointDerivative, OF_DERIVATIVES, NO_DERIVATIVES)
REFUSED(fmi3GetOutputDerivatives, (Unit u, const Reference at[], size_t n, const int32_t orders[], double values[], size_t count),
        ((void)u, (void)at, (void)n, (void)orders, (void)values, (void)count))
REFUSED(fmi3EnterEventMode, (Unit u), (void)u)
REFUSED(fmi3EvaluateDiscreteStates, (Unit u), (void)u)
REFUSED(fmi3UpdateDiscreteStates, (Unit u, bool *a, bool *b, bool *c, bool *d, bool *e, double *f),
        ((void)u, (void)a, (void)b, (void)c, (void)d, (void)e, (void)f))
REFUSED(fmi3GetIntervalDecimal, (Unit u, const Reference at[], size_t n, double a[], int b[]), ((void)u, (void)at, (void)n, (void)a, (void)b))
REFUSED(fmi3GetIntervalFraction, (Unit u, const Reference at[], size_t n, uint64_t a[], uint64_t b[], int c[]),
        ((void)u, (void)at, (void)n, (void)a, (void)b, (void)c))
REFUSED(fmi3GetShiftDecimal, (Unit u, const Reference at[], size_t n, double a[]), ((void)u, (void)at, (void)n, (void)a))
REFUSED(fmi3GetShiftFraction, (Unit u, const Reference at[], size_t n, uint64_t a[], uint64_t b[]),
        ((void)u, (void)at, (void)n, (void)a, (void)b))
REFUSED(fmi3SetIntervalDecimal, (Unit u, const Reference at[], size_t n, const double a[]), ((void)u, (void)at, (void)n, (void)a))
REFUSED(fmi3SetIntervalFraction, (Unit u, const Reference at[], size_t n, const uint64_t a[], const uint64_t b[]),
        ((void)u, (void)at, (void)n, (void)a, (void)b))
REFUSED(fmi3SetShiftDecimal, (Unit u, const Reference at[], size_t n, const double a[]), ((void)u, (void)at, (void)n, (void)a))
REFUSED(fmi3SetShiftFraction, (Unit u, const Reference at[], size_t n, const uint64_t a[], const uint64_t b[]),
        ((void)u, (void)at, (void)n, (void)a, (void)b))
REFUSED(fmi3EnterContinuousTimeMode, (Unit u), (void)u)
REFUSED(fmi3CompletedIntegratorStep, (Unit u, bool a, bool *b, bool *c), ((void)u, (void)a, (void)b, (void)c))
REFUSED(fmi3SetTime, (Unit u, double time), ((void)u, (void)time))
REFUSED(fmi3SetContinuousStates, (Unit u, const double a[], size_t n), ((void)u, (void)a, (void)n))
REFUSED(fmi3GetContinuousStateDerivatives, (Unit u, double a[], size_t n), ((void)u, (void)a, (void)n))
REFUSED(fmi3GetEventIndicators, (Unit u, double a[], size_t n), ((void)u, (void)a, (void)n))
REFUSED(fmi3GetContinuousStates, (Unit u, double a[], size_t n), ((void)u, (void)a, (void)n))
REFUSED(fmi3GetNominalsOfContinuousStates, (Unit u, double a[], size_t n), ((void)u, (void)a, (void)n))
REFUSED(fmi3GetNumberOfEventIndicators, (Unit u, size_t *n), ((void)u, (void)n))
REFUSED(fmi3GetNumberOfContinuousStates, (Unit u, size_t *n), ((void)u, (void)n))
REFUSED(fmi3ActivateModelPartition, (Unit u, Reference clock, double time), ((void)u, (void)clock, (void)time))

FUNCTION(Unit, fmi3InstantiateModelExchange,
         (const char *name, const char *token, const char *resources, bool visible, bool logs, Environment environment, void *log)) {
    (void)name, (void)token, (void)resources, (void)visible, (void)logs, (void)environment, (void)log;
    return NULL;
}

FUNCTION(Unit, fmi3InstantiateScheduledExecution,
         (const char *name, const char *token, const char *resources, bool visible, bool logs, Environment environment, void *log,
          void *update, void *lock, void *unlock)) {
    (void)name, (void)token, (void)resources, (void)visible, (void)logs, (void)environment, (void)log;
    (void)update, (void)lock, (void)unlock;
    return NULL;
}
