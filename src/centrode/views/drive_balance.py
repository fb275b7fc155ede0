"""Balance of a machine's drive in its real motion: what the links need and the flywheel takes is what drives."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from centrode.sheets.sheet import Block, Check, Formula, Paragraph, Section
from centrode.sheets.texts import Expression, Factor, Joined, Leaf, Name, Number, Sentence, Symbol, Text

if TYPE_CHECKING:
    import xarray

SENSE = Sentence("Moments on the drive, positive in the sense in which its coordinate grows:")
REAL_MOTION = Sentence(
    "The forces are those of the real motion: the drive has the angular velocity $omega$ and the angular acceleration "
    "$epsilon$ of the steady motion."
)


def driving_terms(here: xarray.Dataset) -> tuple[float, float, float, float]:
    """Moment of the links, inertia of group I, acceleration, and driving moment of reactions at a real sample."""
    names = ("moment_of_links", "drive_acceleration", "driving_moment")
    links, acceleration, driving = (float(here[name]) for name in names)
    return links, float(here.attrs["inertia"]), acceleration, driving


def moment_of_links(steady: xarray.Dataset) -> float:
    """What the links need of the drive [N m] at one sample of a steady motion, by virtual work."""
    speed, acceleration = float(steady["drive_speed"]), float(steady["drive_acceleration"])
    inertia, slope = float(steady["inertia_of_links"]), float(steady["inertia_slope_of_links"])
    return inertia * acceleration + 0.5 * slope * speed**2 - float(steady["moment_of_loads"])


def terms_of_links(steady: xarray.Dataset) -> float:
    """Sum of the sizes of the terms of `moment_of_links` [N m], by which its rounding is measured."""
    speed, acceleration = float(steady["drive_speed"]), float(steady["drive_acceleration"])
    inertia, slope = float(steady["inertia_of_links"]), float(steady["inertia_slope_of_links"])
    loads = abs(float(steady["moment_of_loads"]))
    return abs(inertia * acceleration) + 0.5 * abs(slope) * speed**2 + loads


def links_line(steady: xarray.Dataset) -> tuple[Leaf, ...]:
    """The balancing moment of the links at one sample of a steady motion, in letters and with numbers."""
    moment = float(steady["moment_of_loads"])
    numbers = Expression(
        "{inertia} dot.op {acceleration} + frac(1, 2) dot.op {slope} dot.op {speed}^(2)"
        f" {'+' if moment < 0 else '-'} {{moment}}",
        inertia=Factor(Number(float(steady["inertia_of_links"]), unit_hidden=True)),
        acceleration=Factor(Number(float(steady["drive_acceleration"]), unit_hidden=True)),
        slope=Factor(Number(float(steady["inertia_slope_of_links"]), unit_hidden=True)),
        speed=Factor(Number(float(steady["drive_speed"]), unit_hidden=True)),
        moment=Number(abs(moment), unit_hidden=True),
    )
    letters = 'J_upright("II") epsilon + 1/2 J\'_upright("II") omega^2 - M_upright(c)'
    return "M_upright(b)", letters, numbers, Number(moment_of_links(steady), "N m", unit_fixed=True)


def driving_lines(
    links: float, inertia: float, acceleration: float, driving: float
) -> tuple[tuple[Leaf, ...], ...]:
    """M_b + J_I epsilon with its numbers, and the driving moment that it equals."""
    numbers = Expression(
        "{links} + {inertia} dot.op {acceleration}",
        links=Number(links, unit_hidden=True),
        inertia=Factor(Number(inertia, unit_hidden=True)),
        acceleration=Factor(Number(acceleration, unit_hidden=True)),
    )
    total = Number(links + inertia * acceleration, "N m", unit_fixed=True)
    return (
        ("M_upright(b) + J_upright(I) epsilon", numbers, total),
        ("M_upright(d)", Number(driving, "N m", unit_fixed=True)),
    )


def factor_text(number: Number) -> Text:
    """A number behind a sign of multiplication: in brackets where it is negative."""
    return Joined((Name("("), number, Name(")")), "") if number.value < 0 else number


def printed_balance(links: float, inertia: float, acceleration: float, driving: float) -> Section:
    """The same as a terminal prints it."""
    letters = Joined((Symbol("M", "b"), Joined((Symbol("J", "I"), Symbol("ε")), "·")), " + ")
    numbers = Joined(
        (Number(links), Joined((Number(inertia), factor_text(Number(acceleration))), "·")), " + "
    )
    total = Joined((letters, numbers, Number(links + inertia * acceleration, "N m")), " = ")
    driven = Joined((Symbol("M", "d"), Number(driving, "N m")), " = ")
    return Section(SENSE, (Paragraph(Joined((total, driven))),))


def drive_balance(
    links: float, inertia: float, acceleration: float, driving: float, size: float, bound: float
) -> Iterator[Block]:
    """The closing check of an instant: what the links need, with what the flywheel takes, beside the driving moment.

    Moments [N m] and accelerations count along the coordinate of the drive. Both sides may differ by the share `bound`
    of `size` [N m].
    """
    yield Paragraph(
        Sentence(
            "Along the coordinate of the drive, the balancing moment $M_upright(b)$ of the links and the moment "
            "$J_upright(I) epsilon$ that accelerates flywheel and shafts add up to the driving moment $M_upright(d)$:"
        )
    )
    yield Formula(driving_lines(links, inertia, acceleration, driving))
    yield Check(
        Sentence(
            "The balancing moment of the links and the moment of flywheel and shafts give the driving moment within "
            "{share} of their terms."
        ),
        abs(links + inertia * acceleration - driving),
        size,
        bound,
    )
