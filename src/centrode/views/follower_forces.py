"""Forces between a cam and its follower: what the terminal, the files, the figure and the document show."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.followers.closed_forms import TURN
from centrode.cams.followers.force_results import (
    strip_loads_difference,
    vanishing_push,
    virtual_work_difference,
)
from centrode.cams.followers.geometry import Oscillating
from centrode.cams.followers.motion_results import ROUNDED
from centrode.quantities import QUANTITIES
from centrode.sheets.plots import AxisLabel, Curve, CurvePanel, Plot
from centrode.sheets.sheet import (
    Block,
    Chapter,
    Check,
    Deferred,
    Fact,
    FactTable,
    Failure,
    Formula,
    Illustration,
    Paragraph,
    Scalar,
    Section,
    Sheet,
    Table,
)
from centrode.sheets.texts import (
    NOTHING,
    Expression,
    Factor,
    Joined,
    Leaf,
    Number,
    Sentence,
    Symbol,
    Text,
    Title,
)
from centrode.views.followers import (
    MEGA,
    angle,
    at,
    course,
    failed_checks,
    in_megapascals,
    letter_of,
    rate,
    turn_table,
    turns_a_minute,
)
from centrode.views.formulas import in_letters, relation, with_numbers
from centrode.views.motion_plots import over_samples, quantity_label

if TYPE_CHECKING:
    from centrode.cams.followers.force_results import FollowerForceResults
    from centrode.model.cam import Material

FLAT_TOP = 1e-9
"""What the place of an extreme, known to some 1e-8 of its stretch, leaves of a value that vanishes."""
PANELS = ("follower_push", "follower_moment", "contact_force", "cam_torque", "contact_stress")
PUSH, STIFFNESS = "push", "stiffness"
SCALARS = {
    "least_push": PUSH,
    "least_push_at": "rad",
    "jump_speed": "rad/s",
    "jump_speed_at": "rad",
    "preload_needed": PUSH,
    "stiffness_needed": STIFFNESS,
    "greatest_force": "N",
    "greatest_force_at": "rad",
    "greatest_torque": "N m",
    "greatest_torque_at": "rad",
    "least_torque": "N m",
    "least_torque_at": "rad",
    "greatest_stress": "Pa",
    "greatest_stress_at": "rad",
}
"""Units of the numbers of the summary; those of a push and of a stiffness depend on the follower."""
Line = tuple[Leaf, ...]


def sheet(results: FollowerForceResults) -> Sheet:
    """Everything there is to say about the forces between a cam and its follower."""
    own = {PUSH: _push_unit(results), STIFFNESS: "N m/rad" if results.cam.swings else "N/m"}
    whole_turn = results.whole_turn
    return Sheet(
        heading=Sentence("Forces on the cam and the follower"),
        facts=tuple(_facts(results)),
        scalars={
            f"cam_{name}": Scalar(whole_turn[name], own.get(unit, unit))
            for name, unit in SCALARS.items()
            if math.isfinite(whole_turn.get(name, math.nan))
        },
        tables=Deferred({"cam-forces": lambda: turn_table(results.dataset)}),
        datasets={"cam-forces": results.dataset},
        pictures=Deferred({"cam-forces": lambda: _plot(results)}),
        chapters=Deferred({"cam-forces": lambda: _chapter(results)}),
        failure=_failure(results),
    )


def _push_unit(results: FollowerForceResults) -> str:
    return "N m" if results.cam.swings else "N"


# Facts


def _facts(results: FollowerForceResults) -> Iterator[Fact]:
    """What keeps the contact, how fast the cam may turn, the greatest forces, torque and stress."""
    whole_turn = results.whole_turn
    speed = turns_a_minute(whole_turn["speed"]) if whole_turn["speed"] else Sentence("none: forces at rest")
    yield Fact(Sentence("speed of the cam"), speed)
    if whole_turn["led"]:
        led = Sentence("no force presses the follower on the cam: it needs form closure")
        yield Fact(Sentence("contact of cam and follower"), led)
    else:
        yield Fact(Sentence("contact of cam and follower"), _contact(results))
        yield Fact(Sentence("separation of the follower"), _jumping(results))
        yield from _springs(results)
    yield from _greatest(results)


def _contact(results: FollowerForceResults) -> Text:
    """The least push."""
    least, place = results.whole_turn["least_push"], results.whole_turn["least_push_at"]
    if least == -math.inf:
        return Sentence("lost: the velocity of the lift drops by a step at {angle}", angle=angle(place))
    push = Number(least, _push_unit(results))
    if least < 0:
        return at(Sentence("lost: {push} along the follower", push=push), place)
    return at(Sentence("kept: at least {push} along the follower", push=push), place)


def _jumping(results: FollowerForceResults) -> Text:
    speed = results.whole_turn["jump_speed"]
    if math.isinf(speed):
        return Sentence("at no speed")
    if speed == 0:
        return Sentence("at every speed")
    return at(Sentence("from {speed} on", speed=turns_a_minute(speed)), results.whole_turn["jump_speed_at"])


def _springs(results: FollowerForceResults) -> Iterator[Fact]:
    """Springs that would just keep the contact at this speed."""
    preload, stiffness = results.whole_turn["preload_needed"], results.whole_turn["stiffness_needed"]
    if math.isinf(preload):
        yield Fact(Sentence("spring needed"), Sentence("none keeps the contact"))
        return
    preloaded = Sentence("with this stiffness no preload")
    if preload > 0:
        value = Number(preload, _push_unit(results))
        preloaded = Sentence("with this stiffness a preload of {value}", value=value)
    yield Fact(Sentence("spring needed"), preloaded)
    stiff = Sentence("with this preload no stiffness")
    if math.isinf(stiffness):
        stiff = Sentence("with this preload no stiffness is sufficient")
    elif stiffness > 0:
        value = Number(stiffness, "N m/rad") if results.cam.swings else Number(1e-3 * stiffness, "N/mm")
        stiff = Sentence("with this preload a stiffness of {value}", value=value)
    yield Fact(NOTHING, stiff)


def _greatest(results: FollowerForceResults) -> Iterator[Fact]:
    """Greatest force, torque, stress."""
    whole_turn, label = results.whole_turn, Sentence("greatest contact force")
    force, place = whole_turn["greatest_force"], whole_turn["greatest_force_at"]
    if math.isinf(force):
        locked = Sentence("unlimited: friction locks the follower at {angle}", angle=angle(place))
        yield Fact(label, locked)
        return
    if math.isnan(force):
        yield Fact(label, Sentence("none is known"))
        return
    yield Fact(label, at(Number(force, "N"), place))
    least, greatest = (
        at(Number(whole_turn[name], "N m"), whole_turn[f"{name}_at"])
        for name in ("least_torque", "greatest_torque")
    )
    torques = Sentence("{least} to {greatest}", least=least, greatest=greatest)
    yield Fact(Sentence("torque of the camshaft"), torques)
    if math.isfinite(whole_turn["works_difference"]):
        apart = Number(whole_turn["works_difference"], "N m", digits=".1g")
        yield Fact(NOTHING, Sentence("by virtual work the torque is the same within {apart}", apart=apart))
    stress = whole_turn.get("greatest_stress", math.nan)
    if math.isfinite(stress):
        value = at(Number(MEGA * stress, "MPa"), whole_turn["greatest_stress_at"])
        yield Fact(Sentence("greatest contact stress"), Joined((value, _bound(results)), ""))


def _bound(results: FollowerForceResults) -> Text:
    """The stress that is admissible, behind the greatest."""
    admissible = results.whole_turn.get("admissible_stress")
    if admissible is None:
        return NOTHING
    stress = Number(MEGA * admissible, "MPa")
    if results.whole_turn["greatest_stress"] <= admissible:
        return Sentence(", admissible {stress}", stress=stress)
    return Sentence(", more than the admissible {stress}", stress=stress)


def _failure(results: FollowerForceResults) -> Failure | None:
    """A follower that is pressed on the cam and jumps all the same, or that friction locks; a stress too great."""
    whole_turn = results.whole_turn
    what: list[Text] = []
    repair: Text = NOTHING
    if not whole_turn["led"] and whole_turn["least_push"] < 0:
        place = angle(whole_turn["least_push_at"])
        what.append(Sentence("the follower leaves the cam at {angle}", angle=place))
        if 0 < whole_turn["jump_speed"] < math.inf:
            repair = Sentence(
                "run it slower than {speed}, or preload the spring with {value}",
                speed=turns_a_minute(whole_turn["jump_speed"]),
                value=Number(whole_turn["preload_needed"], _push_unit(results)),
            )
    if math.isinf(whole_turn["greatest_force"]):
        what.append(Sentence("friction locks the follower: no force of the cam moves it"))
    if whole_turn.get("greatest_stress", math.nan) > whole_turn.get("admissible_stress", math.inf):
        place = angle(whole_turn["greatest_stress_at"])
        what.append(Sentence("the contact stress is not admissible at {angle}", angle=place))
    return Failure(Joined(what, "; "), repair) if what else None


# Figure


def _plot(results: FollowerForceResults) -> Plot:
    """Push, contact force, torque and contact stress over a turn of the cam."""
    dataset, rows = results.dataset, []
    for name in PANELS:
        if name in dataset:
            quantity = QUANTITIES[name]
            values, unit = in_megapascals(dataset[name].values, quantity.unit)
            curve = Curve(Sentence(quantity.long_name), values, 0)
            rows.append((CurvePanel(AxisLabel(symbol=Symbol(quantity.symbol), unit=unit), (curve,)),))
    abscissa = over_samples(quantity_label("cam_angle"), dataset["cam_angle"].values)
    return Plot(
        Sentence("Forces on the cam and the follower"), Title(results.cam.title), abscissa, tuple(rows)
    )


# Chapter


def _chapter(results: FollowerForceResults) -> Chapter:
    """Formulas with numbers where forces are greatest, springs, torque, stress."""
    whole_turn = results.whole_turn
    known, stress = np.isfinite(whole_turn["greatest_force"]), whole_turn.get("greatest_stress", math.nan)
    plot = Illustration("cam-forces", Sentence("Push, contact force, torque and stress over a turn"))
    sections = (
        Section(
            NOTHING, (*_laws(results), FactTable(tuple(_facts(results))), *failed_checks(_failure(results)))
        ),
        Section(Sentence("Greatest contact force"), tuple(_greatest_force(results)) if known else ()),
        Section(Sentence("Contact and spring"), () if whole_turn["led"] else tuple(_keeping(results))),
        Section(Sentence("Torque of the camshaft"), tuple(_torques(results)) if known else ()),
        Section(Sentence("Contact stress"), tuple(_stress(results)) if np.isfinite(stress) else ()),
        Section(Sentence("Over a turn"), (_table(results), plot)),
    )
    return Chapter(
        Sentence("Forces on the cam and the follower"), tuple(one for one in sections if one.blocks)
    )


def _si(value: float, unit: str = "1") -> Number:
    """A number of a formula: their units have to go together."""
    return Number(value, unit, unit_fixed=True)


def _bare(number: Number) -> Number:
    return replace(number, unit_hidden=True)


def _degrees(place: float) -> Expression:
    return Expression("{degrees} degree", degrees=Number(math.degrees(place)))


def _place(place: float) -> Number:
    return Number(place, "rad", digits="")


def _laws(results: FollowerForceResults) -> Iterator[Block]:
    """What the cam has to give, in letters."""
    swings, friction = results.cam.swings, results.forces.friction
    if swings:
        text = Sentence(
            "The cam must exert the moment $Q$ about the pivot: preload and stiffness of the spring, the load "
            "and the inertia of the follower. The corresponding force along the normal is $N$, the torque about "
            "the cam's axis is $T$."
        )
    else:
        text = Sentence(
            "The cam must exert the force $Q$ along the follower: preload and stiffness of the spring, the load "
            "and the inertia of the follower. The corresponding force along the normal is $N$, the torque about "
            "the cam's axis is $T$."
        )
    yield Paragraph(text)
    letters, _numbers = _push_terms(results, (1.0, 1.0, 1.0))
    flat = math.isinf(results.forces.body.touch.roller)
    if friction:
        normal, torque = "frac(Q, b_n + mu b_t)", "N (g_n + mu g_t)"
    else:
        lever = ("q" if flat else "l cos alpha") if swings else ("" if flat else "cos alpha")
        normal, torque = f"frac(Q, {lever})" if lever else "Q", f"Q {rate(swings, 1)}"
    yield Formula((("Q", letters), ("N", normal), ("T", torque)))
    if friction:
        yield Paragraph(
            Sentence(
                "The cam's surface slides on the follower and drags it with the friction force $mu N$; $b_n$ and "
                "$b_t$ are unit forces along the normal and along the friction, reduced to the follower's "
                "motion, $g_n$ and $g_t$ their arms about the cam's axis."
            )
        )


def _push_terms(
    results: FollowerForceResults, lift: tuple[float, float, float], without: str = ""
) -> tuple[str, Expression]:
    """Terms of the push that there are, in letters and with numbers, for a lift and its derivatives.

    `without` leaves out one of them: "preload" or "inertia".
    """
    burden, speed, swings = results.forces.burden, results.forces.speed, results.cam.swings
    letters = {"I": "J" if swings else "m", "s": letter_of(swings), "a": rate(swings, 2)}
    terms: list[str] = []
    values: dict[str, Leaf] = {}
    if burden.preload and without != "preload":
        terms.append("{F_0}")
        values |= {"F_0": _si(burden.preload)}
    if burden.load:
        terms.append("{P}")
        values |= {"P": _si(burden.load)}
    if burden.stiffness:
        terms.append("{k} * {s}")
        values |= {"k": _si(burden.stiffness), "s": Factor(_si(lift[0]))}
    if burden.inertia and speed and without != "inertia":
        terms.append("{I} * {omega}^2 * {a}")
        values |= {"I": _si(burden.inertia), "omega": _si(speed), "a": Factor(_si(lift[2]))}
    notation = " + ".join(terms) or "0"
    return in_letters(notation, values, letters), with_numbers(notation, values)


def _push(results: FollowerForceResults, place: float) -> Number:
    return _si(float(results.forces.at(np.array([place])).push[0]), _push_unit(results))


def _lift_lines(results: FollowerForceResults, place: float) -> Iterator[Line]:
    """Lift and second derivative in SI."""
    swings = results.cam.swings
    value, _slope, second = results.lift_at(place)
    yield letter_of(swings), _si(value, "rad" if swings else "m")
    yield rate(swings, 2), _si(second, "1" if swings else "m/rad^2")


def _push_lines(results: FollowerForceResults, place: float) -> Iterator[Line]:
    """The lift, and the push with its numbers."""
    yield from _lift_lines(results, place)
    letters, numbers = _push_terms(results, results.lift_at(place))
    yield "Q", letters, numbers, _push(results, place)


def _normal_lines(results: FollowerForceResults, place: float) -> Iterator[Line]:
    """The force along the normal."""
    forces, body, swings = results.forces, results.forces.body, results.cam.swings
    phi = np.array([place])
    push, end = _bare(_push(results, place)), _si(float(forces.at(phi).normal[0]), "N")
    contact, flat = body.contact(phi), math.isinf(body.touch.roller)
    if forces.friction:
        along, drag = (_si(one, "m" if swings else "1") for one in results.levers_at(place)[0])
        yield "b_n", along
        yield "b_t", drag
        notation = "frac({Q}, {b_n} + {mu} * {b_t})"
        levers: dict[str, Leaf] = {"b_n": _bare(along), "b_t": Factor(_bare(drag))}
        yield relation("N", notation, end, {"Q": Factor(push), "mu": _si(forces.friction), **levers})
    elif flat and not swings:
        yield "N", "Q", end
    elif flat:
        lever = _si(float(contact.along[0]), "m")
        yield "q", lever
        yield relation("N", "frac({Q}, {q})", end, {"Q": push, "q": _bare(lever)})
    else:
        slope = Factor(_si(math.degrees(float(contact.pressure_angle[0]))))
        steepness: Leaf = Expression("({degrees} degree)", degrees=slope)
        if isinstance(body.guide, Oscillating):
            arm = _si(body.guide.arm)
            yield relation(
                "N", "frac({Q}, {l} * cos {alpha})", end, {"Q": push, "l": arm, "alpha": steepness}
            )
        else:
            yield relation("N", "frac({Q}, cos {alpha})", end, {"Q": push, "alpha": steepness})


def _greatest_force(results: FollowerForceResults) -> Iterator[Block]:
    """The greatest force along the normal, from the lift at its angle."""
    place = float(results.whole_turn["greatest_force_at"])
    yield Paragraph(Sentence("The contact force is greatest at $phi$ = {angle}:", angle=_place(place)))
    yield Formula((*_push_lines(results, place), *_normal_lines(results, place)))


def _keeping(results: FollowerForceResults) -> Iterator[Block]:
    """The least push, the speed of jumping, the springs that are needed."""
    whole_turn, forces = results.whole_turn, results.forces
    yield Paragraph(
        Sentence(
            "The push must stay positive: a cam cannot pull. Where it first becomes zero, the follower leaves the cam."
        )
    )
    if np.isfinite(whole_turn["least_push"]):
        place = float(whole_turn["least_push_at"])
        yield Paragraph(Sentence("The push is least at $phi$ = {angle}:", angle=_place(place)))
        yield Formula(tuple(_push_lines(results, place)))
    speed = whole_turn["jump_speed"]
    if np.isfinite(speed) and speed > 0.0:
        place = float(whole_turn["jump_speed_at"])
        text = Sentence(
            "The least speed at which the push becomes zero is found at $phi$ = {angle}:", angle=_place(place)
        )
        yield Paragraph(text)
        yield Formula((*_lift_lines(results, place), *_jump_lines(results, place, speed)))
        statement = Sentence("At this speed the least push over the turn is {share} of the greatest.")
        yield Check(statement, *vanishing_push(forces, forces.burden, speed), FLAT_TOP)
    needed = whole_turn["preload_needed"]
    if np.isfinite(needed) and forces.burden.inertia and forces.speed:
        place = float(whole_turn["preload_needed_at"])
        letters, numbers = _push_terms(results, results.lift_at(place), without="preload")
        worked, end = Expression("-({terms})", terms=numbers), _si(needed, _push_unit(results))
        yield Paragraph(Sentence("A spring of this stiffness keeps the contact with at least the preload"))
        yield Formula((("phi", _degrees(place)), ('F_(0, "min")', f"-({letters})", worked, end)))
        if needed > 0.0:
            statement = Sentence("With this preload the least push over the turn is {share} of the greatest.")
            sprung = replace(forces.burden, preload=needed)
            yield Check(statement, *vanishing_push(forces, sprung, forces.speed), FLAT_TOP)
        else:
            yield Paragraph(
                Sentence("As it is not positive, the stiffness alone is sufficient, without preload.")
            )


def _jump_lines(results: FollowerForceResults, place: float, speed: float) -> Iterator[Line]:
    """The speed at which the push is zero there."""
    swings, lift = results.cam.swings, results.lift_at(place)
    letters, numbers = _push_terms(results, lift, without="inertia")
    yield relation(
        'omega_"j"',
        "sqrt(frac({rest}, -{I} * {a}))",
        _si(speed, "rad/s"),
        {"rest": numbers, "I": _si(results.forces.burden.inertia), "a": Factor(_si(lift[2]))},
        {"rest": letters, "I": "J" if swings else "m", "a": rate(swings, 2)},
    )
    yield 'n_"j"', 'frac(30, pi) omega_"j"', turns_a_minute(speed)


def _torques(results: FollowerForceResults) -> Iterator[Block]:
    """The greatest and the least torque; negative where the follower drives the cam."""
    greatest, least = (float(results.whole_turn[f"{name}_torque_at"]) for name in ("greatest", "least"))
    yield Paragraph(
        Sentence("The torque of the camshaft is greatest at $phi$ = {angle}:", angle=_place(greatest))
    )
    yield Formula(tuple(_torque_lines(results, greatest)))
    yield Paragraph(
        Sentence(
            "It is least at $phi$ = {angle}; where it is negative the follower drives the cam:",
            angle=_place(least),
        )
    )
    yield Formula(tuple(_torque_lines(results, least)))
    statement = Sentence(
        "At {count} angles the moment of the contact force about the cam's axis agrees with virtual work within "
        "{share} of force times radius.",
        count=Number(len(TURN)),
    )
    if results.forces.friction:
        statement = Sentence(
            "At {count} angles the work of the contact force's moment about the cam's axis equals that of push "
            "and friction within {share} of force times radius.",
            count=Number(len(TURN)),
        )
    yield Check(statement, *virtual_work_difference(results.forces), ROUNDED)


def _torque_lines(results: FollowerForceResults, place: float) -> Iterator[Line]:
    """Slope, push, and the torque about the cam's axis."""
    forces, swings = results.forces, results.cam.swings
    acting, push = forces.at(np.array([place])), _push(results, place)
    slope, end = (
        _si(results.lift_at(place)[1], "1" if swings else "m/rad"),
        _si(float(acting.torque[0]), "N m"),
    )
    yield rate(swings, 1), slope
    yield "Q", push
    if not forces.friction:
        factors = {"Q": Factor(_bare(push)), "slope": Factor(_bare(slope))}
        yield relation("T", "{Q} * {slope}", end, factors, {"slope": rate(swings, 1)})
        return
    normal = _si(float(acting.normal[0]), "N")
    arm, drag_arm = (_si(one, "m") for one in results.levers_at(place)[1])
    yield "N", normal
    yield "g_n", arm
    yield "g_t", drag_arm
    yield relation(
        "T",
        "{N} * ({g_n} + {mu} * {g_t})",
        end,
        {
            "N": Factor(_bare(normal)),
            "g_n": _bare(arm),
            "mu": _si(forces.friction),
            "g_t": Factor(_bare(drag_arm)),
        },
    )


def _stress(results: FollowerForceResults) -> Iterator[Block]:
    """The line contact after Hertz at its worst angle: load of the strip, curvatures, modulus, stress, half width."""
    place = float(results.whole_turn["greatest_stress_at"])
    phi, forces = np.array([place]), results.forces
    acting, contact, roller = forces.at(phi), forces.body.contact(phi), forces.body.touch.roller
    strip, width, modulus = acting.strip, forces.width, forces.modulus
    assert strip is not None and width is not None and modulus is not None
    force = abs(float(acting.normal[0]))
    load, rolls = force / width, math.isfinite(roller)
    curvature = (1.0 / roller if rolls else 0.0) + float(contact.curvature[0])
    radii: dict[str, Leaf] = {"r": _si(roller)} if rolls else {}
    radii |= {"R": Factor(_si(float(contact.bend[0])))}
    first, second = results.cam.body.material, results.cam.follower.material
    compliances = {"first": _compliance(first or second), "second": _compliance(second or first)}
    text = Sentence(
        "Hertz's formulas hold along the line of contact of length $b$; the stress is greatest at $phi$ = "
        "{angle}:",
        angle=_place(place),
    )
    yield Paragraph(text)
    yield Formula(
        (
            ("phi", _degrees(place)),
            relation("w", "frac({N}, {b})", _si(load, "N/m"), {"N": _si(force), "b": _si(width)}),
            relation(
                "kappa", " + ".join(f"frac(1, {{{name}}})" for name in radii), _si(curvature, "1/m"), radii
            ),
            (
                "frac(1, E^*)",
                "frac(1 - nu_1^2, E_1) + frac(1 - nu_2^2, E_2)",
                Expression("{first} + {second}", **compliances),
                Expression("frac(1, {modulus})", modulus=_si(MEGA * modulus, "MPa")),
            ),
            relation(
                "sigma",
                "sqrt(frac({w} * {kappa} * {E}, pi))",
                _si(MEGA * float(strip.pressure[0]), "MPa"),
                {"w": _si(load), "kappa": _si(curvature), "E": _si(modulus)},
                {"E": "E^*"},
            ),
            ("a", "sqrt(frac(4 w, pi kappa E^*))", _si(1e3 * float(strip.half_width[0]), "mm")),
        )
    )
    statement = Sentence(
        "The elliptic pressure, integrated across the strip, equals the load within {share} of it."
    )
    yield Check(statement, strip_loads_difference(forces), 1.0, ROUNDED)


def _compliance(material: Material | None) -> Expression:
    assert material is not None  # the modulus of a contact is known where one material is
    return Expression(
        "frac(1 - {poisson}^2, {elasticity})",
        poisson=_si(material.poisson),
        elasticity=_si(MEGA * material.elasticity),
    )


def _table(results: FollowerForceResults) -> Table:
    push = "follower_moment" if results.cam.swings else "follower_push"
    columns = [(push, "Q"), ("contact_force", "N"), ("cam_torque", "T")]
    if "contact_stress" in results.dataset:
        columns += [("contact_stress", "sigma"), ("contact_half_width", "a")]
    caption = Sentence("Forces over a turn; a dash where the contact is lost or the value is unknown")
    return course(results.dataset, columns, caption, brief=True)
