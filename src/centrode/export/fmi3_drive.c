/* The motion of one drive as a model: its reduced equation, or its value, speed and acceleration as inputs. The printed motion stands
 * before, and defines: MODEL, the type of its record; PREPARE and AT, its functions; MODEL_DIMENSIONS; output_rows, and output_turns,
 * whether whole turns of the drive are added; DYNAMIC, WRAPS, PERIOD, FIRST_PLACE, DRIVE_UNIT, what its
 * displacements are compared with, and SHAFT_INERTIA.
 */
typedef struct {
    MODEL motion;
    double turned[OUTPUTS > 0 ? OUTPUTS : 1];   /* what a whole turn of the drive adds to each output */
    double first;
    int wraps;
} fmu_model;

static void prepare_model(fmu_model *m, const double dimensions[]) {
    double first[OUTPUTS > 0 ? OUTPUTS : 1];
    PREPARE(&m->motion, dimensions);
    m->wraps = 0;
    m->first = FIRST_PLACE;
    if (!WRAPS || AT(&m->motion, FIRST_PLACE, 1.0, 0.0) != 0) return;
    for (int k = 0; k < OUTPUTS; k++) first[k] = m->motion.row[output_rows[k]];
    if (AT(&m->motion, FIRST_PLACE + PERIOD, 1.0, 0.0) != 0) return;
    for (int k = 0; k < OUTPUTS; k++) {
        const double grown = m->motion.row[output_rows[k]] - first[k];
        m->turned[k] = output_turns[k] ? PERIOD * floor(grown / PERIOD + 0.5) : 0.0;
        if (!(fabs(grown - m->turned[k]) <= 1e-6 * (1.0 + fabs(first[k])))) return;
    }
    m->wraps = 1;
}

/* The value of the drive within the range that was printed, and the whole turns that were taken off. */
static double wrapped(const fmu_model *m, double drive, double *turns) {
    *turns = 0.0;
    if (m->wraps) *turns = floor((drive - m->first) / PERIOD);
    return drive - *turns * PERIOD;
}

/* Derivatives of the states at a time; NaN where the mechanism does not reach. */
static void rates(fmu_model *m, double time, const double inputs[], const double state[], double rate[]) {
#if STATES
    double turns;
    const double place = wrapped(m, state[0], &turns);
    rate[0] = state[1];
    rate[1] = NAN;
    if (AT(&m->motion, place, state[1], 0.0) != 0) return;
    m->motion.time = time;
    set_place(&m->motion, place, 0.0);
    evaluate_reduced(&m->motion);
    const double inertia = m->motion.reduced[0] + SHAFT_INERTIA, slope = m->motion.reduced[1];
    rate[1] = (m->motion.reduced[2] + inputs[0] - 0.5 * slope * state[1] * state[1]) / inertia;
#else
    (void)m; (void)time; (void)inputs; (void)state; (void)rate;
#endif
}

/* Outputs, and the status as a number. */
static int outputs_of(fmu_model *m, double time, const double inputs[], const double state[], const double rate[], double output[]) {
    const double *drive = DYNAMIC ? state : inputs;
    double turns;
    const int status = AT(&m->motion, wrapped(m, drive[0], &turns), drive[1], DYNAMIC ? rate[1] : inputs[2]);
    (void)time; (void)rate;
    for (int k = 0; k < OUTPUTS; k++) output[k] = m->motion.row[output_rows[k]] + turns * m->turned[k];
    return status;
}

#if STATES
/* What positions of the drive count in: a radian, or the size of the mechanism. */
static double nominal_position(int k) {
    (void)k;
    return DRIVE_UNIT;
}
#endif

/* Every state of one drive is a position. */
static double close_states(fmu_model *m, double time, double state[]) {
    (void)m; (void)time; (void)state;
    return INFINITY;
}
