"""Limits, change points and statuses of one mechanism, place by place: rules that are printed in other languages.

These are functions of plain numbers and of one record, in the few words that `numerics.rule_translation` knows.
They keep to the rules of `kinematics.events` and `kinematics.samples`, but walk over cells one by one: what a
cell cannot decide is halved, so that no mesh is kept. The formulas that the record's `evaluate_` functions
stand for are printed from its graph.
"""

from __future__ import annotations

from math import atan2, cos, floor, nan, pi, sin
from typing import Protocol

TURN = 2.0 * pi
OK, OPEN, CUT_OFF, SINGULAR, OUTSIDE = 0, 1, 2, 3, 4
"""Statuses of a place; the first four are those of `errors.Status`, the last says that the place was not looked at."""
LIMIT, CHANGE = 0, 1
NOTHING, HALVE, CROSSING = 0, 1, 2
"""What a cell says of a condition: it keeps its sign, it is not known, it passes zero once."""
ROOM = 1.0 + 1e-6
"""How much more than their bounds numbers may stray."""
SUSPECT, SAFETY = 1e-8, 16.0
"""A radicand below this share of its greatest value is compared with its rounding error, so many times over."""
WINDOW, BESIDE = 0.04, 0.02
"""Half widths about change points [units of the path]: where a group is not judged, where formulas lack digits."""
CIRCLE, AROUND = 0.24, 20
"""How far the places of a polynomial about a change point lie [units of the path], and how many there are."""
AT_THE_START = 1e-9
FINEST, TOUCHING, TOUCHED = 1e-10, 1e-2, 1e-6
"""Half widths [units of the path]: of the least cell, of cells whose minimum is looked for, of what is one touch."""
CELLS = 30000
"""Cells that one condition may take."""
STEPS = 100
EVENTS = 64
"""Events that are kept."""


class Record(Protocol):
    """Numbers of one mechanism.

    Attributes
    ----------
    guards : conditions of the groups in the order of the plan, radicands and divisors
    is_radicand, start_sign, radicand_row : of each guard; the sign of its group in the initial position
    counted, angles : angles that gears and wheels depend on, and angles of links whose turns are counted
    nodes, node_first, node_step : places at which angles are counted
    node_angle, node_near : angles with their turns at the nodes
    row, rows : what is computed at a place: results, then residual, radicands and the least length of a cylinder
    """

    guards: int
    counted: int
    angles: int
    dimensions: int
    nodes: int
    rows: int
    smooth: int
    turns_matter: int
    start_node: int
    wide_cells: int
    initial: float
    forward: float
    unit: float
    node_first: float
    node_step: float
    low: float
    high: float
    closed: float
    given: list[float]
    is_length: list[float]
    is_radicand: list[float]
    start_sign: list[float]
    radicand_row: list[float]
    counted_start: list[float]
    angle_row: list[float]
    angle_start: list[float]
    is_derivative: list[float]
    of_frame: list[float]

    place: float
    half: float
    rate: float
    second: float
    sign: list[float]
    near: list[float]
    turns: list[float]
    row: list[float]
    cell: list[float]
    curve: list[float]
    bound: list[float]
    rotor: list[float]
    angle: list[float]
    node_angle: list[float]
    node_near: list[float]

    largest: list[float]
    events: int
    event_kind: list[float]
    event_guard: list[float]
    event_place: list[float]
    event_behind: list[float]
    event_closes: list[float]
    reach_low: float
    reach_high: float
    possible: int
    cells: int
    stack_at: list[float]
    stack_half: list[float]
    first: list[float]
    above: list[float]

    def evaluate_numbers(self) -> None: ...
    def evaluate_motion(self) -> None: ...
    def evaluate_cells(self, last: int) -> None: ...
    def evaluate_curves(self, last: int) -> None: ...
    def evaluate_bounds(self, last: int) -> None: ...
    def evaluate_rotors(self) -> None: ...
    def evaluate_counted(self) -> None: ...


# Places.


def node_of(m: Record, x: float) -> int:
    """The node next to a place."""
    # in other languages whole numbers are of a kind of their own
    node: int = int(floor((x - m.node_first) / m.node_step + 0.5))  # noqa: RUF046
    if node < 0:
        node = 0
    if node > m.nodes - 1:
        node = m.nodes - 1
    return node


def set_place(m: Record, x: float, half: float) -> None:
    """The signs and the counted angles that hold at a place."""
    m.place = x
    m.half = half
    least: float = min(x, m.initial)
    greatest: float = max(x, m.initial)
    for k in range(m.guards):
        m.sign[k] = m.start_sign[k]
    if m.smooth > 0:
        for e in range(m.events):
            if m.event_kind[e] == CHANGE and least < m.event_behind[e] and m.event_behind[e] < greatest:
                m.sign[int(m.event_guard[e])] = -m.sign[int(m.event_guard[e])]
    if m.counted > 0:
        node: int = node_of(m, x)
        for c in range(m.counted):
            m.near[c] = m.node_near[node * m.counted + c]


def evaluate_curve(m: Record, k: int, x: float) -> None:
    """Value, slope and second derivative of a guard at a place, among the record's curves."""
    set_place(m, x, 0.0)
    m.evaluate_curves(k)


def find_root(m: Record, k: int, lower: float, upper: float) -> float:
    """The zero of a guard between two places of opposite signs: Newton's steps, halving where these lead outside."""
    low: float = lower
    high: float = upper
    evaluate_curve(m, k, low)
    positive: int = 0
    if m.curve[3 * k] >= 0.0:
        positive = 1
    x: float = 0.5 * (low + high)
    for _trial in range(STEPS):
        evaluate_curve(m, k, x)
        value: float = m.curve[3 * k]
        slope: float = m.curve[3 * k + 1]
        same: int = 0
        if value >= 0.0:
            same = 1
        if same == positive:
            low = x
        else:
            high = x
        bit: float = 2.5e-16 * max(abs(x), 1e-3 * m.unit)
        if value == 0.0 or high - low <= bit:
            return x
        following: float = 0.5 * (low + high)
        if slope != 0.0:
            step: float = x - value / slope
            if abs(step - x) <= bit:
                return x
            if step > low and step < high:
                following = step
        x = following
    return x


# The search for events.


def add_event(m: Record, kind: int, k: int, x: float) -> None:
    """Keep a limit or a change point; a limit says on which side of it the mechanism closes."""
    if m.events < EVENTS:
        e: int = m.events
        m.event_kind[e] = kind
        m.event_guard[e] = k
        m.event_place[e] = x
        m.event_behind[e] = x
        m.event_closes[e] = 0.0
        if kind == LIMIT:
            evaluate_curve(m, k, x)
            m.event_closes[e] = m.curve[3 * k + 1]
        elif abs(x - m.initial) <= AT_THE_START * m.unit:
            # what stands at the start counts as passed behind it
            m.event_behind[e] = m.initial - m.forward * AT_THE_START * m.unit
        m.events = e + 1


def is_known(m: Record, k: int, x: float, around: float) -> int:
    """Whether an event of a guard is kept about a place."""
    for e in range(m.events):
        if m.event_guard[e] == k and abs(m.event_place[e] - x) <= around:
            return 1
    return 0


def look_for_touch(m: Record, k: int, centre: float, half: float) -> None:
    """Keep the place at which a guard touches zero, where it does about a cell."""
    x: float = centre
    for _trial in range(8):
        evaluate_curve(m, k, x)
        slope: float = m.curve[3 * k + 1]
        second: float = m.curve[3 * k + 2]
        # rounding may give a touching guard the other sign; far from zero this is no minimum
        bent_away: int = 0
        if m.curve[3 * k] * second > 0.0 or abs(m.curve[3 * k]) <= SUSPECT * m.largest[k]:
            bent_away = 1
        if bent_away == 0 or second == 0.0:
            return
        step: float = slope / second
        x = x - step
        if not abs(x - centre) <= 4.0 * half:
            return
    known: int = is_known(m, k, x, TOUCHED * m.unit)
    if known > 0:
        return
    set_place(m, x, 0.0)
    m.evaluate_bounds(k)
    if not abs(m.bound[2 * k]) <= SAFETY * m.bound[2 * k + 1]:
        return
    evaluate_curve(m, k, x + 0.5 * TOUCHING * m.unit)
    after: float = m.curve[3 * k]
    evaluate_curve(m, k, x)
    if m.is_radicand[k] > 0.0:
        # a radicand that is negative on both sides is no way through
        if m.curve[3 * k + 2] > 0.0 and x > m.low and x < m.high:
            add_event(m, CHANGE, k, x)
            if m.smooth > 0 and m.counted > 0:
                count_angles(m)
    elif after == after and x > m.low and x < m.high:
        add_event(m, LIMIT, k, x)


def judge_cell(m: Record, k: int, x: float, half: float) -> int:
    """What bounds say of a guard in a cell."""
    set_place(m, x, half)
    m.evaluate_cells(k)
    for j in range(k):
        size_before: float = abs(m.cell[3 * j])
        strays_before: float = ROOM * (abs(m.cell[3 * j + 1]) * half + 0.5 * half * half * m.cell[3 * j + 2])
        # where a group before is open all over the cell, this one has no value
        if m.is_radicand[j] > 0.0 and m.cell[3 * j] < 0.0 and size_before > strays_before:
            return NOTHING
    value: float = m.cell[3 * k]
    slope: float = m.cell[3 * k + 1]
    bend: float = m.cell[3 * k + 2]
    size: float = abs(value)
    strays: float = abs(slope) * half + 0.5 * half * half * bend
    if size < 1e300 and size > m.largest[k]:
        m.largest[k] = size
    if size > ROOM * strays or (slope == 0.0 and bend == 0.0):
        return NOTHING
    known: int = is_known(m, k, x, TOUCHED * m.unit + half)
    if known > 0 and half <= TOUCHED * m.unit:
        return NOTHING
    if abs(slope) > ROOM * bend * half or half <= FINEST * m.unit:
        evaluate_curve(m, k, x - half)
        before: float = m.curve[3 * k]
        evaluate_curve(m, k, x + half)
        behind: float = m.curve[3 * k]
        if before == before and behind == behind:
            if (before >= 0.0 and behind < 0.0) or (before < 0.0 and behind >= 0.0):
                return CROSSING
            return NOTHING
    if half <= FINEST * m.unit:
        return NOTHING
    return HALVE


def search_guard(m: Record, k: int) -> None:
    """Keep all events of a guard between the ends of the range."""
    wide: float = (m.high - m.low) / m.wide_cells
    m.cells = 0
    for c in range(m.wide_cells):
        m.stack_at[0] = m.low + (c + 0.5) * wide
        m.stack_half[0] = 0.5 * wide
        depth: int = 1
        while depth > 0 and m.cells < CELLS:
            depth = depth - 1
            m.cells = m.cells + 1
            x: float = m.stack_at[depth]
            half: float = m.stack_half[depth]
            known: int = 0
            verdict: int = judge_cell(m, k, x, half)
            if verdict == CROSSING:
                root: float = find_root(m, k, x - half, x + half)
                known = is_known(m, k, root, 2.0 * FINEST * m.unit)
                if known == 0:
                    add_event(m, LIMIT, k, root)
            elif verdict == HALVE:
                known = is_known(m, k, x, 4.0 * half)
                if half <= TOUCHING * m.unit and known == 0:
                    look_for_touch(m, k, x, half)
                m.stack_at[depth] = x + 0.5 * half
                m.stack_half[depth] = 0.5 * half
                m.stack_at[depth + 1] = x - 0.5 * half
                m.stack_half[depth + 1] = 0.5 * half
                depth = depth + 2


def count_angles(m: Record) -> None:
    """Angles that gears and wheels depend on at the nodes, with their turns, outwards from the initial position."""
    for side in range(2):
        for c in range(m.counted):
            m.first[c] = m.counted_start[c]
        node: int = m.start_node
        while node >= 0 and node < m.nodes:
            set_place(m, m.node_first + node * m.node_step, 0.0)
            m.evaluate_counted()
            for c in range(m.counted):
                raw: float = m.angle[c]
                if raw == raw and abs(raw) < 1e300:
                    m.first[c] = raw + TURN * floor((m.first[c] - raw) / TURN + 0.5)
                m.node_near[node * m.counted + c] = m.first[c]
            node = node + 1 - 2 * side


def count_turns(m: Record) -> None:
    """Angles of links at the nodes, with their turns, outwards from the initial position."""
    for side in range(2):
        for a in range(m.angles):
            m.first[a] = m.angle_start[a]
        node: int = m.start_node
        while node >= 0 and node < m.nodes:
            set_place(m, m.node_first + node * m.node_step, 0.0)
            m.evaluate_rotors()
            for a in range(m.angles):
                cosine: float = m.rotor[2 * a]
                sine: float = m.rotor[2 * a + 1]
                if abs(cosine) < 1e300 and abs(sine) < 1e300:
                    raw: float = atan2(sine, cosine)
                    m.first[a] = raw + TURN * floor((m.first[a] - raw) / TURN + 0.5)
                m.node_angle[node * m.angles + a] = m.first[a]
            node = node + 1 - 2 * side


def find_reach(m: Record) -> None:
    """The nearest limits on both sides of the initial position."""
    m.reach_low = -1e300
    m.reach_high = 1e300
    for e in range(m.events):
        if m.event_kind[e] == LIMIT:
            below: int = 0
            if abs(m.event_place[e] - m.initial) <= AT_THE_START * m.unit:
                if m.event_closes[e] > 0.0:
                    below = 1
            elif m.event_place[e] <= m.initial:
                below = 1
            if below > 0:
                m.reach_low = max(m.reach_low, m.event_place[e])
            else:
                m.reach_high = min(m.reach_high, m.event_place[e])


def find_events(m: Record) -> None:
    """What follows from the numbers of a mechanism: its limits and change points, and the turns of its angles."""
    m.events = 0
    m.reach_low = -1e300
    m.reach_high = 1e300
    m.possible = 1
    for d in range(m.dimensions):
        if not abs(m.given[d]) < 1e300 or (m.is_length[d] > 0.0 and not m.given[d] > 0.0):
            m.possible = 0
    if m.possible == 0:
        return
    m.evaluate_numbers()
    m.rate = 1.0
    m.second = 0.0
    for k in range(m.guards):
        m.largest[k] = 0.0
    if m.counted > 0:
        count_angles(m)
    for k in range(m.guards):
        search_guard(m, k)
    find_reach(m)
    if m.angles > 0:
        count_turns(m)


# One place.


def is_beside_change(m: Record, k: int, x: float) -> int:
    """Whether a place lies so near a change point of a guard that the guard says nothing."""
    if m.smooth > 0:
        for e in range(m.events):
            near: float = abs(x - m.event_place[e])
            if m.event_kind[e] == CHANGE and m.event_guard[e] == k and near < WINDOW * m.unit:
                return 1
    return 0


def count_turns_here(m: Record, x: float) -> None:
    """The whole turns of every angle at a place, from its angle without turns and the node next to it."""
    node: int = node_of(m, x)
    for a in range(m.angles):
        raw: float = m.row[int(m.angle_row[a])]
        m.turns[a] = 0.0
        if raw == raw:
            m.turns[a] = floor((m.node_angle[node * m.angles + a] - raw) / TURN + 0.5)


def judge_radicands(m: Record, x: float) -> int:
    """The status that radicands give; signs of those that are zero within rounding become zero."""
    status: int = OK
    again: int = 1
    while again > 0:
        again = 0
        status = OK
        for k in range(m.guards):
            if m.is_radicand[k] > 0.0:
                value: float = m.row[int(m.radicand_row[k])]
                little: float = SUSPECT * m.largest[k]
                if value <= little:
                    mended: int = is_beside_change(m, k, x)
                    within: int = 0
                    if abs(value) <= little:
                        within = is_rounding(m, k, x)
                    if within > 0:
                        if m.sign[k] != 0.0:
                            m.sign[k] = 0.0
                            again = 1
                        if mended == 0 and status != OPEN:
                            status = SINGULAR
                    elif value < 0.0 and mended == 0:
                        status = OPEN
        if again > 0:
            m.evaluate_motion()
    return status


def is_rounding(m: Record, k: int, x: float) -> int:
    """Whether a guard at the record's place is zero within its rounding error."""
    m.evaluate_bounds(k)
    if abs(m.bound[2 * k]) <= SAFETY * m.bound[2 * k + 1]:
        return 1
    return 0


def mend_beside_change(m: Record, x: float) -> None:
    """Beside a change point the motion is the polynomial through places on both sides, as its formulas lose digits."""
    for e in range(m.events):
        if m.smooth > 0 and m.event_kind[e] == CHANGE and abs(x - m.event_place[e]) < BESIDE * m.unit:
            reach: float = CIRCLE * m.unit
            for other in range(m.events):
                apart: float = abs(m.event_place[other] - m.event_place[e])
                if apart > BESIDE * m.unit:
                    reach = min(reach, 0.5 * apart)
            if reach >= 2.0 * BESIDE * m.unit:
                mend_place(m, x, m.event_place[e], reach)


def mend_place(m: Record, x: float, centre: float, reach: float) -> None:
    """Rows of a place as the barycentric polynomial through places at Chebyshev's distances from a centre."""
    below: float = 0.0
    greatest: float = 0.0
    share: float = 0.0
    relative: float = (x - centre) / reach
    for r in range(m.rows + 1):
        m.above[r] = 0.0
    for q in range(AROUND):
        node: float = cos(pi * (2.0 * q + 1.0) / (2.0 * AROUND))
        weight: float = sin(pi * (2.0 * q + 1.0) / (2.0 * AROUND)) * (1.0 - 2.0 * (q - 2.0 * floor(0.5 * q)))
        # a place that is a node itself is moved by a rounding
        if relative == node:
            relative = relative + 1e-15
        share = weight / (relative - node)
        set_place(m, centre + reach * node, 0.0)
        m.evaluate_motion()
        if q == 0:
            for r in range(m.rows + 1):
                m.first[r] = m.row[r]
        for a in range(m.angles):
            # angles without turns may jump between two of the places
            turning: int = int(m.angle_row[a])
            m.row[turning] = m.row[turning] - TURN * floor((m.row[turning] - m.first[turning]) / TURN + 0.5)
        below = below + share
        greatest = max(greatest, m.row[m.rows])
        for r in range(m.rows + 1):
            m.above[r] = m.above[r] + share * m.row[r]
    for r in range(m.rows):
        m.row[r] = m.above[r] / below
    for a in range(m.angles):
        turned: int = int(m.angle_row[a])
        m.row[turned] = m.row[turned] - TURN * floor(m.row[turned] / TURN + 0.5)
    # what the formulas say in a place without digits is no residual of the motion
    m.row[m.rows] = greatest


def motion_at(m: Record, x: float, rate: float, second: float) -> int:
    """The motion at a place of the path, and its status."""
    status: int = OUTSIDE
    m.rate = rate
    m.second = second
    if m.possible == 0:
        settle_rows(m, OPEN)
        return OPEN
    if x >= m.low and x <= m.high:
        set_place(m, x, 0.0)
        for a in range(m.angles):
            m.turns[a] = 0.0
        m.evaluate_motion()
        if m.turns_matter > 0:
            count_turns_here(m, x)
            m.evaluate_motion()
        length: float = m.row[m.rows + 1]
        status = judge_radicands(m, x)
        if status == OK:
            mend_beside_change(m, x)
        status = judge_rows(m, status, x)
        if length <= 0.0:
            status = OPEN
        residual: float = m.row[m.rows]
        if status != OPEN and residual > m.closed:
            status = OPEN
    settle_rows(m, status)
    if status != OUTSIDE:
        count_turns_here(m, x)
        for a in range(m.angles):
            row: int = int(m.angle_row[a])
            m.row[row] = m.row[row] + TURN * m.turns[a]
    return status


def judge_rows(m: Record, before: int, x: float) -> int:
    """The status with what numbers that are none say, and limits that were passed."""
    status: int = before
    if m.events > 0 or not m.row[m.rows] <= m.closed:
        for r in range(m.rows):
            if status == OK and not abs(m.row[r]) < 1e300:
                status = SINGULAR
    margin: float = 1e-15 * max(1.0, abs(x))
    if status != OPEN and (x < m.reach_low - margin or x > m.reach_high + margin):
        status = CUT_OFF
    return status


def settle_rows(m: Record, status: int) -> None:
    """Absence is no number: nothing stands in open places, and no derivatives in singular ones."""
    nothing: int = 0
    if status == OPEN or status == OUTSIDE:  # noqa: SIM109 -- rules know no other comparison
        nothing = 1
        m.row[m.rows] = nan
    for r in range(m.rows):
        absent: int = nothing
        if status == SINGULAR and m.is_derivative[r] > 0.0:
            absent = 1
        if not abs(m.row[r]) < 1e300:
            absent = 1
        if absent > 0 and status != OK and (nothing > 0 or m.of_frame[r] == 0.0):
            m.row[r] = nan
