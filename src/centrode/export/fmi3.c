/* FMI 3.0 around a model: model exchange and co-simulation. The model stands before: its type fmu_model with prepare_model, rates,
 * outputs_of, nominal_position and close_states; and OUTPUTS, PARAMETERS, INPUTS, STATES, START_INPUTS, START_STATES, MODEL_DIMENSIONS and TOKEN.
 *
 * Variables by their references: 0 time; from 1 inputs; 10 status; 11 tolerance of co-simulation; from 100 dimensions; from 1000
 * outputs; from 100000 states; from 200000 their derivatives.
 */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#if defined(_WIN32)
#define EXPORTED __declspec(dllexport)
#else
#define EXPORTED __attribute__((visibility("default")))
#endif

typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef void (*LogMessage)(void *environment, fmi3Status status, const char *category, const char *message);

enum { FIRST_DIMENSION = 100, FIRST_OUTPUT = 1000, FIRST_STATE = 100000, FIRST_DERIVATIVE = 200000 };

typedef struct {
    fmu_model model;
    double dimensions[PARAMETERS > 0 ? PARAMETERS : 1];
    double inputs[INPUTS > 0 ? INPUTS : 1];
    double start[STATES > 0 ? STATES : 1], state[STATES > 0 ? STATES : 1], derivative[STATES > 0 ? STATES : 1];
    double time, tolerance, step, longest;
    int prepared, evaluated, status;
    double output[OUTPUTS > 0 ? OUTPUTS : 1];
    void *environment;
    LogMessage log;
} instance;

static fmi3Status fail(instance *c, const char *message) {
    if (c->log) c->log(c->environment, fmi3Error, "logStatusError", message);
    return fmi3Error;
}

static const double start_inputs[] = START_INPUTS, start_states[] = START_STATES;

static void reset(instance *c) {
    memcpy(c->dimensions, MODEL_DIMENSIONS, sizeof(double) * PARAMETERS);
    memcpy(c->inputs, start_inputs, sizeof(double) * INPUTS);
    memcpy(c->start, start_states, sizeof(double) * STATES);
    memcpy(c->state, start_states, sizeof(double) * STATES);
    c->time = 0.0;
    c->tolerance = 1e-9;
    c->step = 0.0;
    c->longest = INFINITY;
    c->prepared = c->evaluated = 0;
}

static void prepare(instance *c) {
    prepare_model(&c->model, c->dimensions);
    c->prepared = 1;
    c->evaluated = 0;
}

static fmi3Status evaluate(instance *c) {
    if (c->evaluated) return fmi3OK;
    if (!c->prepared) prepare(c);
    rates(&c->model, c->time, c->inputs, c->state, c->derivative);
    c->status = outputs_of(&c->model, c->time, c->inputs, c->state, c->derivative, c->output);
    c->evaluated = 1;
    return fmi3OK;
}

#if STATES
/* One step of Dormand and Prince's pair of orders 5 and 4; returns the error in units of the tolerance. */
static double try_step(instance *c, double h, double next[]) {
    static const double nodes[] = {0.0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1.0, 1.0};
    static const double weights[7][6] = {
        {0}, {1.0 / 5}, {3.0 / 40, 9.0 / 40}, {44.0 / 45, -56.0 / 15, 32.0 / 9},
        {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
        {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
        {35.0 / 384, 0.0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
    static const double errors[] = {71.0 / 57600, 0.0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
    double k[7][STATES], worst = 0.0;
    for (int s = 0; s < 7; s++) {
        for (int i = 0; i < STATES; i++) {
            next[i] = c->state[i];
            for (int j = 0; j < s; j++) next[i] += h * weights[s][j] * k[j][i];
        }
        rates(&c->model, c->time + nodes[s] * h, c->inputs, next, k[s]);
    }
    for (int i = 0; i < STATES; i++) {
        double error = 0.0;
        for (int s = 0; s < 7; s++) error += h * errors[s] * k[s][i];
        const double share = fabs(error) / (c->tolerance * (1e-3 + fmax(fabs(c->state[i]), fabs(next[i]))));
        if (!(share <= worst)) worst = share;
    }
    return worst;
}

static fmi3Status integrate(instance *c, double end) {
    double next[STATES];
    if (!c->prepared) prepare(c);
    if (!(c->step > 0.0)) c->step = 1e-3;
    for (int steps = 0; c->time < end; steps++) {
        const double left = end - c->time, size = fmin(c->step, c->longest), h = size < left ? size : left;
        if (steps > 1000000 || !(h > 1e-14 * (1.0 + fabs(c->time)))) return fail(c, "the motion does not reach the end of the step");
        const double error = try_step(c, h, next);
        if (error <= 1.0) {
            c->time = h == left ? end : c->time + h;
            c->longest = close_states(&c->model, c->time, next);
            if (c->longest < 0.0) return fail(c, "the mechanism stands at a change point");
            memcpy(c->state, next, sizeof(next));
        }
        const double factor = error == error ? 0.9 * pow(fmax(error, 1e-10), -0.2) : 0.1;
        const double wanted = h * fmin(5.0, fmax(0.1, factor));
        if (error <= 1.0 && h < c->step) continue;   /* cut short by the end of the step: nothing was learnt */
        c->step = wanted;
    }
    c->evaluated = 0;
    return fmi3OK;
}
#endif

/* What importers call. */

static instance *create(const char *token, void *environment, LogMessage log) {
    if (token && strcmp(token, TOKEN) != 0) return NULL;
    instance *c = calloc(1, sizeof(instance));
    if (!c) return NULL;
    c->environment = environment;
    c->log = log;
    reset(c);
    return c;
}

EXPORTED const char *fmi3GetVersion(void) { return "3.0"; }

EXPORTED void *fmi3InstantiateModelExchange(const char *name, const char *token, const char *resources, bool visible, bool logging,
                                            void *environment, LogMessage log) {
    (void)name; (void)resources; (void)visible; (void)logging;
    return create(token, environment, log);
}

EXPORTED void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources, bool visible, bool logging,
                                           bool event_mode, bool early_return, const uint32_t required[], size_t count,
                                           void *environment, LogMessage log, void (*update)(void)) {
    (void)name; (void)resources; (void)visible; (void)logging; (void)event_mode; (void)early_return;
    (void)required; (void)count; (void)update;
    return create(token, environment, log);
}

EXPORTED void *fmi3InstantiateScheduledExecution(const char *name, const char *token, const char *resources, bool visible,
                                                 bool logging, void *environment, LogMessage log, void (*clock)(void),
                                                 void (*lock)(void), void (*unlock)(void)) {
    (void)name; (void)token; (void)resources; (void)visible; (void)logging; (void)environment; (void)log;
    (void)clock; (void)lock; (void)unlock;
    return NULL;
}

EXPORTED void fmi3FreeInstance(void *c) { free(c); }

EXPORTED fmi3Status fmi3EnterInitializationMode(void *p, bool tolerance_defined, double tolerance, double start, bool stop_defined,
                                                double stop) {
    instance *c = p;
    (void)stop_defined; (void)stop;
    if (tolerance_defined && tolerance > 0.0) c->tolerance = tolerance;
    c->time = start;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3ExitInitializationMode(void *p) {
    instance *c = p;
    memcpy(c->state, c->start, sizeof(c->state));
    prepare(c);
    for (int k = 0; STATES && k < 20; k++) c->longest = close_states(&c->model, c->time, c->state);
    return c->longest < 0.0 ? fail(c, "the mechanism stands at a change point") : fmi3OK;
}

EXPORTED fmi3Status fmi3Reset(void *p) {
    reset(p);
    return fmi3OK;
}

EXPORTED fmi3Status fmi3GetFloat64(void *p, const uint32_t references[], size_t count, double values[], size_t size) {
    instance *c = p;
    (void)size;
    for (size_t k = 0; k < count; k++) {
        const uint32_t r = references[k];
        if (r >= FIRST_OUTPUT && evaluate(c) != fmi3OK) return fmi3Error;
        if (r == 0) values[k] = c->time;
        else if (r >= 1 && r < 1 + INPUTS) values[k] = c->inputs[r - 1];
        else if (r >= FIRST_STATE && r < FIRST_STATE + STATES) values[k] = c->state[r - FIRST_STATE];
        else if (r >= FIRST_DERIVATIVE && r < FIRST_DERIVATIVE + STATES) values[k] = c->derivative[r - FIRST_DERIVATIVE];
        else if (r == 11) values[k] = c->tolerance;
        else if (r >= FIRST_DIMENSION && r < FIRST_DIMENSION + PARAMETERS) values[k] = c->dimensions[r - FIRST_DIMENSION];
        else if (r >= FIRST_OUTPUT && r < FIRST_OUTPUT + OUTPUTS) values[k] = c->output[r - FIRST_OUTPUT];
        else return fail(c, "no such variable");
    }
    return fmi3OK;
}

EXPORTED fmi3Status fmi3SetFloat64(void *p, const uint32_t references[], size_t count, const double values[], size_t size) {
    instance *c = p;
    (void)size;
    c->evaluated = 0;
    for (size_t k = 0; k < count; k++) {
        const uint32_t r = references[k];
        if (r >= 1 && r < 1 + INPUTS) c->inputs[r - 1] = values[k];
        else if (r >= FIRST_STATE && r < FIRST_STATE + STATES) c->state[r - FIRST_STATE] = c->start[r - FIRST_STATE] = values[k];
        else if (r == 11) c->tolerance = values[k];
        else if (r >= FIRST_DIMENSION && r < FIRST_DIMENSION + PARAMETERS) {
            c->dimensions[r - FIRST_DIMENSION] = values[k];
            c->prepared = 0;
        } else return fail(c, "this variable is not set");
    }
    return fmi3OK;
}

EXPORTED fmi3Status fmi3GetInt32(void *p, const uint32_t references[], size_t count, int32_t values[], size_t size) {
    instance *c = p;
    (void)size;
    for (size_t k = 0; k < count; k++) {
        if (references[k] != 10) return fail(c, "no such variable");
        if (evaluate(c) != fmi3OK) return fmi3Error;
        values[k] = c->status;
    }
    return fmi3OK;
}

EXPORTED fmi3Status fmi3SetTime(void *p, double time) {
    instance *c = p;
    c->time = time;
    c->evaluated = 0;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3SetContinuousStates(void *p, const double states[], size_t count) {
    instance *c = p;
    for (size_t k = 0; k < count && k + 1 <= STATES; k++) c->state[k] = states[k];
    c->evaluated = 0;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3GetContinuousStates(void *p, double states[], size_t count) {
    instance *c = p;
    for (size_t k = 0; k < count && k + 1 <= STATES; k++) states[k] = c->state[k];
    return fmi3OK;
}

EXPORTED fmi3Status fmi3GetContinuousStateDerivatives(void *p, double derivatives[], size_t count) {
    instance *c = p;
    if (evaluate(c) != fmi3OK) return fmi3Error;
    for (size_t k = 0; k < count && k + 1 <= STATES; k++) derivatives[k] = c->derivative[k];
    for (size_t k = 0; k < count && k + 1 <= STATES; k++) {
        if (c->derivative[k] != c->derivative[k]) return fail(c, "the mechanism does not reach this state");
    }
    return fmi3OK;
}

/* Positions count in radians or sizes of the mechanism, their speeds in what the mechanism gains within one of them: integrators of
 * importers take absolute tolerances from these, and lose steps and digits where speeds of 1000 rad/s are held to those of 1 rad/s.
 */
EXPORTED fmi3Status fmi3GetNominalsOfContinuousStates(void *p, double nominals[], size_t count) {
#if STATES
    enum { POSITIONS = STATES / 2 };
    instance *c = p;
    double pace = 0.0;
    if (evaluate(c) != fmi3OK) return fmi3Error;
    for (int k = 0; k < POSITIONS; k++) {
        const double unit = nominal_position(k), speed = fabs(c->state[POSITIONS + k]) / unit;
        const double gained = sqrt(fabs(c->derivative[POSITIONS + k]) / unit);
        if (speed > pace) pace = speed;
        if (gained > pace) pace = gained;
    }
    if (!(pace > 0.0 && pace < INFINITY)) pace = 1.0;
    for (int k = 0; k < STATES && (size_t)k < count; k++) {
        nominals[k] = k < POSITIONS ? nominal_position(k) : pace * nominal_position(k - POSITIONS);
    }
#else
    (void)p; (void)nominals; (void)count;
#endif
    return fmi3OK;
}

EXPORTED fmi3Status fmi3GetNumberOfContinuousStates(void *p, size_t *count) {
    (void)p;
    *count = STATES;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3GetNumberOfEventIndicators(void *p, size_t *count) {
    (void)p;
    *count = 0;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3UpdateDiscreteStates(void *p, bool *again, bool *ends, bool *nominals, bool *values, bool *timed, double *next) {
    (void)p; (void)next;
    *again = *ends = *nominals = *values = *timed = false;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3CompletedIntegratorStep(void *p, bool no_state, bool *event, bool *ends) {
    (void)p; (void)no_state;
    *event = *ends = false;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3DoStep(void *p, double time, double size, bool no_state, bool *event, bool *ends, bool *early, double *last) {
    instance *c = p;
    (void)no_state;
    *event = *ends = *early = false;
    fmi3Status status = fmi3OK;
#if STATES
    c->time = time;
    status = integrate(c, time + size);
#endif
    if (status == fmi3OK) c->time = time + size;
    c->evaluated = 0;
    *last = c->time;
    return status;
}

EXPORTED fmi3Status fmi3GetFMUState(void *p, void **state) {
    if (!*state && !(*state = malloc(sizeof(instance)))) return fmi3Error;
    memcpy(*state, p, sizeof(instance));
    return fmi3OK;
}

EXPORTED fmi3Status fmi3SetFMUState(void *p, void *state) {
    memcpy(p, state, sizeof(instance));
    return fmi3OK;
}

EXPORTED fmi3Status fmi3FreeFMUState(void *p, void **state) {
    (void)p;
    free(*state);
    *state = NULL;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3GetEventIndicators(void *p, double indicators[], size_t count) {
    (void)p; (void)indicators; (void)count;
    return fmi3OK;
}

/* Changes of mode ask for nothing. */
#define NOTHING_TO_DO(name) EXPORTED fmi3Status name(void *p) { (void)p; return fmi3OK; }
NOTHING_TO_DO(fmi3EnterEventMode)
NOTHING_TO_DO(fmi3EnterContinuousTimeMode)
NOTHING_TO_DO(fmi3EnterStepMode)
NOTHING_TO_DO(fmi3EnterConfigurationMode)
NOTHING_TO_DO(fmi3ExitConfigurationMode)
NOTHING_TO_DO(fmi3EvaluateDiscreteStates)
NOTHING_TO_DO(fmi3Terminate)

EXPORTED fmi3Status fmi3SetDebugLogging(void *p, bool on, size_t count, const char *const categories[]) {
    (void)p; (void)on; (void)count; (void)categories;
    return fmi3OK;
}

/* Kinds of variables and abilities that the model does not have. */
#define ABSENT(name) EXPORTED fmi3Status name(void *p) { return fail(p, #name " is not supported"); }
ABSENT(fmi3GetFloat32) ABSENT(fmi3GetInt8) ABSENT(fmi3GetUInt8) ABSENT(fmi3GetInt16) ABSENT(fmi3GetUInt16) ABSENT(fmi3GetUInt32)
ABSENT(fmi3GetInt64) ABSENT(fmi3GetUInt64) ABSENT(fmi3GetBoolean) ABSENT(fmi3GetString) ABSENT(fmi3GetBinary) ABSENT(fmi3GetClock)
ABSENT(fmi3SetFloat32) ABSENT(fmi3SetInt8) ABSENT(fmi3SetUInt8) ABSENT(fmi3SetInt16) ABSENT(fmi3SetUInt16) ABSENT(fmi3SetInt32)
ABSENT(fmi3SetUInt32) ABSENT(fmi3SetInt64) ABSENT(fmi3SetUInt64) ABSENT(fmi3SetBoolean) ABSENT(fmi3SetString)
ABSENT(fmi3SetBinary) ABSENT(fmi3SetClock) ABSENT(fmi3GetNumberOfVariableDependencies) ABSENT(fmi3GetVariableDependencies)
ABSENT(fmi3SerializedFMUStateSize) ABSENT(fmi3SerializeFMUState) ABSENT(fmi3DeserializeFMUState)
ABSENT(fmi3GetDirectionalDerivative) ABSENT(fmi3GetAdjointDerivative) ABSENT(fmi3GetIntervalDecimal) ABSENT(fmi3GetIntervalFraction)
ABSENT(fmi3GetShiftDecimal) ABSENT(fmi3GetShiftFraction) ABSENT(fmi3SetIntervalDecimal) ABSENT(fmi3SetIntervalFraction)
ABSENT(fmi3SetShiftDecimal) ABSENT(fmi3SetShiftFraction) ABSENT(fmi3GetOutputDerivatives)
ABSENT(fmi3ActivateModelPartition)
