/* The motion of all links as a model: joint coordinates and their speeds as states. The printed equations stand before: the type
 * record, evaluate_accelerations, evaluate_closing and evaluate_outputs; and COORDINATES, the number of coordinates; LENGTH, what
 * displacements are compared with; coordinate_is_length.
 */
typedef record fmu_model;

/* Closures less independent than this are lost: the mechanism stands at a change point, and nothing tells how it goes on. */
#define LOST 1e-3
enum { SINGULAR = 3 };

static void prepare_model(fmu_model *m, const double dimensions[]) { (void)m; (void)dimensions; }

static void put_state(fmu_model *m, double time, const double state[]) {
    m->time = time;
    for (int k = 0; k < COORDINATES; k++) {
        m->coordinate[k] = state[k];
        m->speed[k] = state[COORDINATES + k];
    }
}

/* Derivatives of the states at a time. */
static void rates(fmu_model *m, double time, const double inputs[], const double state[], double rate[]) {
    put_state(m, time, state);
    for (int k = 0; k < INPUTS; k++) m->input[k] = inputs[k];
    evaluate_accelerations(m);
    for (int k = 0; k < COORDINATES; k++) {
        rate[k] = state[COORDINATES + k];
        rate[COORDINATES + k] = m->acceleration[k];
    }
}

/* Outputs, and the status as a number. */
static int outputs_of(fmu_model *m, double time, const double inputs[], const double state[], const double rate[], double output[]) {
    put_state(m, time, state);
    for (int k = 0; k < INPUTS; k++) m->input[k] = inputs[k];
    (void)rate;
    evaluate_outputs(m);
    for (int k = 0; k < OUTPUTS; k++) output[k] = m->row[k];
    evaluate_closing(m);
    return m->closed[2 * COORDINATES] > LOST ? 0 : SINGULAR;
}

/* What a coordinate counts in: a radian, or the size of the mechanism. */
static double nominal_position(int k) { return coordinate_is_length[k] ? LENGTH : 1.0; }

/* Close the position and fit the speeds by one step of Newton's method; returns how long the next step may be, so that it passes no
 * change point, or less than 0 at one.
 */
static double close_states(fmu_model *m, double time, double state[]) {
    double fastest = 1e-9;
    put_state(m, time, state);
    evaluate_closing(m);
    for (int k = 0; k < 2 * COORDINATES; k++) state[k] = m->closed[k];
    for (int k = 0; k < COORDINATES; k++) {
        const double speed = fabs(m->closed[COORDINATES + k]) / nominal_position(k);
        if (speed > fastest) fastest = speed;
    }
    const double independence = m->closed[2 * COORDINATES];
    if (!(independence > LOST)) return -1.0;
    return independence < 0.25 ? 0.5 * independence / fastest : INFINITY;
}
