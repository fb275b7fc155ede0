"""A random plate cam: its lift with derivatives, its profile, normals, curvature and undercut beside the envelope."""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import mpmath
import numpy as np
import tomli_w

import centrode as ct
from centrode.cams.followers.motion import follower_motion
from centrode.errors import CentrodeError
from tools.campaigns.campaign import Campaign, Outcome, random_of
from tools.campaigns.cams.envelopes import DIGITS, Layout, touch
from tools.campaigns.cams.laws import RISES, Lift, Segment
from tools.campaigns.columns import EPS

SAMPLES = 12
ORDERS = 4
STEP = mpmath.mpf(10) ** -10
LIFT = 16.0
"""Errors of lift and derivatives, in roundings of the size of their terms."""
PLACE = 32.0
"""Errors of places in roundings of the cam's size times the conditioning of the guidance."""
BEND = 1e-13
"""Relative error of radii of curvature, the size of the cam and the second derivative of the lift counted in."""
LEADING = ("cannot be led", "misses the base circle", "no triangle", "turn faster", "90", "reach")


def drawn(seed: int, number: int) -> tuple[dict[str, Any], Layout, Lift, np.random.Generator]:
    """The description of a case, its layout and its lift."""
    random = random_of(seed, number)
    kind = str(random.choice(["translating", "oscillating"]))
    contact = str(random.choice(["knife", "roller", "flat"]))
    base = float(random.uniform(0.02, 0.08))
    greatest = float(random.choice([0.3, 0.6, 1.5]) * random.uniform(0.1, 1.0)) * (
        base if kind == "translating" else 0.6
    )
    lift = lift_of(random, greatest)
    sense = float(random.choice([-1.0, 1.0]))
    follower: dict[str, Any] = {"kind": kind, "contact": contact}
    more: dict[str, float] = {}
    if contact == "roller":
        more["roller"] = follower["roller_radius"] = float(random.uniform(0.1, 1.0)) * base
    if kind == "translating":
        more["offset"] = follower["offset"] = float(random.uniform(-0.4, 0.4)) * base
    else:
        reach = base + more.get("roller", 0.0)
        more["distance"] = follower["pivot_distance"] = float(random.uniform(1.8, 3.0)) * reach
        if contact == "flat":
            more["face_offset"] = follower["face_offset"] = float(random.uniform(-0.3, 0.3)) * base
        else:
            more["arm"] = follower["arm"] = float(random.uniform(0.9, 1.1)) * math.sqrt(
                more["distance"] ** 2 - reach**2
            )
    parts = {
        "kind": "cam",
        "cam": {"base_radius": base, "turn": "counter-clockwise" if sense > 0.0 else "clockwise"},
        "follower": follower,
        "segments": [row(one) for one in lift.segments],
        "study": {"show_undercut": True},
    }
    return parts, Layout(kind, contact, base, sense, **more), lift, random


def lift_of(random: np.random.Generator, greatest: float) -> Lift:
    """Two to six segments that fill a turn and end at 0."""
    count = int(random.integers(2, 7))
    shares = random.uniform(0.5, 2.0, count)
    angles = [float(x) for x in shares / np.sum(shares) * math.tau]
    angles[-1] = math.tau - math.fsum(angles[:-1])
    heights = [0.0, *(float(x) for x in random.uniform(0.0, greatest, count - 1)), 0.0]
    found = []
    for k, angle in enumerate(angles):
        begin, end = heights[k], heights[k + 1]
        # a cam that lifts nothing is refused
        curve = str(random.choice([*RISES, "polynomial", *(["dwell"] if k else [])]))
        if curve == "dwell" and k < count - 1:
            heights[k + 1] = end = begin
        if curve == "dwell" and begin != end:
            curve = "cycloidal"
        if curve == "polynomial":
            found.append(polynomial(random, angle, begin, end, greatest))
        else:
            found.append(Segment(angle, begin, end, curve if begin != end else "dwell"))
    return Lift(tuple(found))


def polynomial(
    random: np.random.Generator, angle: float, begin: float, end: float, greatest: float
) -> Segment:
    """A polynomial with derivatives at its ends and up to two points on the way."""
    ends = [
        [float(x) * greatest for x in random.uniform(-0.2, 0.2, int(random.integers(0, 3)))] for _ in range(2)
    ]
    places = sorted(float(x) * angle for x in random.uniform(0.3, 0.7, int(random.integers(0, 2))))
    through = [(x, float(random.uniform(min(begin, end), max(begin, end)))) for x in places]
    return Segment(angle, begin, end, "polynomial", ends[0], ends[1], through)


def row(segment: Segment) -> dict[str, Any]:
    """A segment as the description has it."""
    found: dict[str, Any] = {"angle": segment.angle, "curve": segment.curve}
    if segment.curve != "dwell":
        found["to"] = segment.end
    if segment.curve == "polynomial":
        found |= {"at_start": list(segment.at_start), "at_end": list(segment.at_end)}
        if segment.through:
            found["through"] = [list(one) for one in segment.through]
    return found


def run(seed: int, number: int) -> Outcome:
    """Lift, profile, normal, curvature and undercut at random angles."""
    parts, layout, lift, random = drawn(seed, number)
    text = tomli_w.dumps(parts)
    outcome = Outcome(text)
    cam = ct.parse_cam(text)
    phi = np.sort(random.uniform(0.0, math.tau, SAMPLES))
    found = follower_motion(cam).lift(phi, ORDERS)
    with mpmath.workdps(DIGITS):
        compare_lift(outcome, lift, phi, found)
        try:
            body = ct.follower_cam(cam)
        except CentrodeError as refusal:
            outcome.count("refused")
            if not any(words in str(refusal) for words in LEADING):
                outcome.fault(f"refused: {refusal}")
            return outcome
        outcome.count("samples", SAMPLES)
        compare_profile(outcome, layout, lift, phi, body)
    return outcome


def derivatives(function: Any, at: Any, orders: int) -> list[Any]:
    """A function with its derivatives by central differences of many digits."""
    values = [function(at + (k - 2) * STEP) for k in range(5)]
    a, b, c, d, e = values
    return [
        c,
        (a - 8 * b + 8 * d - e) / (12 * STEP),
        (-a + 16 * b - 30 * c + 16 * d - e) / (12 * STEP**2),
        (e - 2 * d + 2 * b - a) / (2 * STEP**3),
        (a - 4 * b + 6 * c - 4 * d + e) / STEP**4,
    ][: orders + 1]


def compare_lift(outcome: Outcome, lift: Lift, phi: Any, found: Any) -> None:
    """Lift and derivatives beside the truth, in the size of the terms that they are sums of."""
    for k, angle in enumerate(phi):
        begun, segment = lift.segment_at(float(angle))
        exact = derivatives(segment.value, mpmath.mpf(float(angle)) - begun, ORDERS)
        for order in range(ORDERS + 1):
            size = term_size(segment, order)
            error = abs(float(mpmath.mpf(float(found[order, k])) - exact[order]))
            outcome.hold(segment.curve, f"s{chr(39) * order}", error / (EPS * size), LIFT)


def term_size(segment: Segment, order: int) -> float:
    """Size of the terms of a derivative; the angle itself counts as rounded over a turn."""
    height = max(abs(segment.begin), abs(segment.end))
    if segment.curve == "dwell":
        return max(height, 1e-6)
    beta = segment.angle
    if segment.curve == "polynomial":
        segment.value(mpmath.mpf(0))
        terms = [
            abs(float(c)) * math.perm(n, order) for n, c in enumerate(segment.coefficients) if n >= order
        ]
        slopes = [
            abs(float(c)) * math.perm(n, order + 1) for n, c in enumerate(segment.coefficients) if n > order
        ]
        return (sum(terms) + math.tau / beta * sum(slopes)) / beta**order + 1e-6
    # polynomials of degree 7 have factors up to 35 * 4 * 3 * ..., waves 4 pi to a power
    factor = (1.0, 8.0, 60.0, 800.0, 10000.0, 60000.0)
    return height * (factor[order] + math.tau / beta * factor[order + 1]) / beta**order


def shifted(segment: Segment, begun: Any, phi: Any) -> Any:
    """The lift of a segment by the angle of the cam."""
    return segment.value(phi - begun)


def compare_profile(outcome: Outcome, layout: Layout, lift: Lift, phi: Any, body: Any) -> None:
    """The profile beside the envelope."""
    contact = body.contact(phi)
    row = f"{layout.kind}, {layout.contact}"
    size = layout.base + layout.roller + layout.arm + layout.distance
    for k, angle in enumerate(phi):
        begun, segment = lift.segment_at(float(angle))
        exact = touch(layout, partial(shifted, segment, begun), mpmath.mpf(float(angle)))
        slopes = derivatives(segment.value, mpmath.mpf(float(angle)) - begun, 3)
        rate = 1.0 + sum(term_size(segment, order) for order in range(3)) / (
            size if layout.kind == "translating" else 1.0
        )
        place = mpmath.mpc(*(mpmath.mpf(float(x)) for x in contact.place[k]))
        normal = mpmath.mpc(*(mpmath.mpf(float(x)) for x in contact.normal[k]))
        outcome.hold(row, "place", float(abs(place - exact.place)) / (EPS * size * rate), PLACE)
        outcome.hold(row, "normal", float(abs(normal - exact.normal)) / (EPS * rate), 8.0 * PLACE)
        radius, bend = float(exact.radius), float(contact.bend[k])
        counted = abs(radius) + (radius / size) ** 2 * size * rate + size * rate + abs(float(slopes[3]))
        outcome.hold(row, "radius", abs(bend - radius) / counted, BEND)
        within = any(
            one.start <= angle <= one.stop or one.start <= angle + math.tau <= one.stop
            for one in body.undercuts
        )
        near = min((abs(angle - x) for one in body.undercuts for x in (one.start, one.stop)), default=1.0)
        if within != exact.back and near > 1e-6:
            outcome.fault(
                f"{row}: at {angle!r} undercut is told to be {within}, the envelope runs back: {exact.back}"
            )
        outcome.count("samples that are undercut", int(exact.back))


CAMPAIGN = Campaign(
    name="cams",
    title="Plate cams",
    about="""Random plate cams: translating and oscillating followers with an edge, a roller or a flat face, either
sense of turning, offsets, two to six segments of all curves, polynomials by conditions among them.

The oracle writes the curves of rise from textbooks and solves the polynomials' conditions at 60 digits; derivatives
are difference quotients. The profile is the envelope of the follower's places in the cam's axes, its curvature comes
from how the normal turns along it; where the place of contact runs back the cam is undercut.""",
    columns={
        "s": f"error of the lift, in roundings of the terms of its formula; bound {LIFT:g}",
        "s'": "of its first derivative by the angle of the cam, and so on",
        "s''": "second",
        "s'''": "third",
        "s''''": "fourth",
        "place": f"error of the profile, in roundings of the size of cam and follower; bound {PLACE:g}",
        "normal": f"of its unit normal; bound {8.0 * PLACE:g}",
        "radius": f"of the radius of curvature, relative to it and to the size; bound {BEND:g}",
    },
    run=run,
    cases=5000,
)
