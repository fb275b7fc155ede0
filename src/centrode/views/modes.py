"""Modes: natural frequencies, damping and shapes on a terminal, in files, figures and documents."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from math import tau
from typing import TYPE_CHECKING

from centrode.sheets.linkages import MechanismPicture
from centrode.sheets.players import MotionPlayer
from centrode.sheets.sheet import (
    Chapter,
    Column,
    Deferred,
    Fact,
    FactTable,
    Formula,
    Illustration,
    Paragraph,
    Section,
    Sheet,
    Table,
)
from centrode.sheets.texts import NOTHING, Name, Number, Sentence, Symbol, Text
from centrode.views.equilibrium import STABILITY, coordinate_units, numbers_from_one, place_text

if TYPE_CHECKING:
    import xarray as xr

    from centrode.dynamics.equilibria.modes import ModesResults
    from centrode.sheets.pictures import Picture

DRAWN = 8
"""Modes that pictures show."""


def sheet(results: ModesResults) -> Sheet:
    """Every mode with its frequency, its damping and its shape."""
    found = results.modes
    return Sheet(
        facts=tuple(_facts(found)),
        tables={"modes": _table(found)},
        datasets={"modes": found},
        pictures=Deferred(dict(_pictures(results))),
        chapters={"modes": _chapter(results)},
        printed=tuple(
            MotionPlayer(
                results.mechanism, results.motions[k], by_time=True, title=_title(results, k), loops=True
            )
            for k in range(min(len(results.motions), DRAWN))
        ),
    )


def _facts(found: xr.Dataset) -> Iterator[Fact]:
    yield Fact(Sentence("degrees of freedom"), Number(int(found.attrs["mobility"]), digits="d"))
    steady = found.attrs["speed"] != "{}"
    yield Fact(Sentence("steady rotation") if steady else Sentence("equilibrium"), place_text(found))
    yield Fact(Sentence("stability"), STABILITY[str(found.attrs["stability"])])
    for k in range(found.sizes["mode"]):
        yield Fact(Sentence("mode {number}", number=Number(k + 1, digits="d")), _mode_text(found, k))


def _mode_text(found: xr.Dataset, k: int) -> Text:
    """Frequency and damping, or how fast it creeps."""
    growth, damped = float(found["growth_rate"].values[k]), float(found["damped_frequency"].values[k])
    if damped:
        ratio = float(found["damping_ratio"].values[k])
        frequency = Number(damped / tau, "Hz")
        if not ratio:
            return Sentence("{frequency}, without damping", frequency=frequency)
        return Sentence(
            "{frequency}, damping ratio {ratio}", frequency=frequency, ratio=Number(ratio, digits=".4g")
        )
    if growth > 0.0:
        return Sentence("grows by {rate} without oscillating", rate=Number(growth, "1/s"))
    if growth < 0.0:
        return Sentence("dies away by {rate} without oscillating", rate=Number(-growth, "1/s"))
    return Sentence("is not driven back")


def _table(found: xr.Dataset) -> Table:
    """One row a mode."""
    columns = [
        Column("mode", numbers_from_one(found.sizes["mode"]), head=Sentence("mode")),
        Column("natural_frequency", found["natural_frequency"].values, "rad/s", Symbol("ω", "0"), unit_fixed=True),
        Column("frequency", found["damped_frequency"].values / tau, "Hz", Symbol("f")),
        Column("damping_ratio", found["damping_ratio"].values, "1", Symbol("ζ")),
        Column("growth_rate", found["growth_rate"].values, "1/s", Symbol("σ")),
    ]  # fmt: skip
    units = coordinate_units(found["mode_amplitude"])
    for k, (name, unit) in enumerate(zip(found["coordinate"].values, units, strict=True)):
        columns += [
            Column(
                f"amplitude_{name}",
                found["mode_amplitude"].values[:, k],
                unit,
                Name(str(name)),
                unit_fixed=True,
            ),
            Column(
                f"phase_{name}",
                found["mode_phase"].values[:, k],
                "rad",
                Sentence("phase of {name}", name=Name(str(name))),
            ),
        ]
    return Table(tuple(columns), Sentence("Modes"))


def _pictures(results: ModesResults) -> Iterator[tuple[str, Callable[[], Picture]]]:
    for k in range(min(len(results.motions), DRAWN)):
        yield f"mode-{k + 1}", partial(_shape, results, k)


def _title(results: ModesResults, k: int) -> Sentence:
    number = Number(k + 1, digits="d")
    return Sentence("Mode {number}: {frequency}", number=number, frequency=_mode_text(results.modes, k))


def _shape(results: ModesResults, k: int) -> MechanismPicture:
    """The mechanism in its equilibrium over fading pictures of the mode, drawn larger than it is."""
    return MechanismPicture(_title(results, k), results.mechanism, results.motions[k], captioned=False)


def _chapter(results: ModesResults) -> Chapter:
    found = results.modes
    text = Sentence(
        "Small motions are sums of exponentials along the modes. The matrices are those of the linearised equations "
        "along the motions $bold(N)$ that the joints allow; their entries are exact derivatives of the equations."
    )
    equations = Formula(
        (
            ("bold(x)(t)", "sum_k c_k bold(N) bold(u)_k e^(s_k t)"),
            ("(s^2 bold(m) + s bold(c) + bold(k)) bold(u)", "bold(0)"),
            ("omega_0", "abs(s)"),
            ("zeta", "-frac(Re s, abs(s))"),
        )
    )
    blocks: list[Section] = [
        Section(NOTHING, (Paragraph(text), equations, FactTable(tuple(_facts(found))), _table(found)))
    ]
    for k, (name, _make) in enumerate(_pictures(results)):
        player = MotionPlayer(results.mechanism, results.motions[k], by_time=True, loops=True)
        title = Sentence("Mode {number}", number=Number(k + 1, digits="d"))
        blocks.append(Section(title, (Illustration(name), player)))
    return Chapter(Sentence("Natural oscillations"), tuple(blocks))
