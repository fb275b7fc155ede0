"""What a description with `[machine]` asks for: energies, flywheel, real motion; in rows and in numbers."""

from __future__ import annotations

from dataclasses import dataclass, fields
from math import degrees
from typing import TypeAlias

import xarray as xr

from centrode.dynamics.steady_motion.balance import Mean
from centrode.dynamics.steady_motion.flywheel import Flywheel, flywheel_of
from centrode.dynamics.steady_motion.sizes import SOURCE_DISC, SOURCE_RIM, Wheel
from centrode.dynamics.steady_motion.solution import solution_of
from centrode.dynamics.steady_motion.steady import Method, steady_dataset, turned_at
from centrode.locale import _, ngettext
from centrode.model.mechanism import Mechanism
from centrode.quantities import display_unit
from centrode.study.scalars import Scalar

Rows: TypeAlias = list[tuple[str, str]]

UNITS = {
    "mean_speed": "rad/s",
    "fluctuation": "1",
    "turns": "1",
    "work_of_loads": "J",
    "driving_moment": "N m",
    "error": "J",
    "energy_greatest": "J",
    "greatest_at": "rad",
    "energy_least": "J",
    "least_at": "rad",
    "present": "kg m^2",
    "least_speed": "rad/s",
    "greatest_speed": "rad/s",
    "time_of_cycle": "s",
    "obtained": "1",
    "inertia_first_order": "kg m^2",
    "inertia_by_tangents": "kg m^2",
    "inertia": "kg m^2",
    "inertia_in_time": "kg m^2",
    "added": "kg m^2",
    "added_first_order": "kg m^2",
}
WHEEL_UNITS = {
    "outer": "m",
    "inner": "m",
    "width": "m",
    "mass": "kg",
    "inertia": "kg m^2",
    "rim_speed": "m/s",
}
WHEELS = ("rim", "disc", "source_rim", "source_disc")


@dataclass(frozen=True)
class MachineResults:
    """A machine in steady motion.

    Attributes
    ----------
    flywheel : Flywheel
    steady : the labelled steady motion over a cycle
    instants : the same at the instants the description asks for; None without any
    """

    flywheel: Flywheel
    steady: xr.Dataset
    instants: xr.Dataset | None


def machine_results(
    mechanism: Mechanism, samples: int | None = None, mean: Mean = "middle", method: Method = "exact"
) -> MachineResults:
    """Everything about the machine of a description; arguments and errors are those of `ct.steady_motion`."""
    found = solution_of(mechanism, mean)
    places = mechanism.study.instants if found.prepared.parameter.is_uniform else ()
    instants = steady_dataset(found, turned_at(found, at=places), method) if places else None
    return MachineResults(
        flywheel_of(found), steady_dataset(found, turned_at(found, samples), method), instants
    )


def flywheel_scalars(found: Flywheel) -> dict[str, Scalar]:
    """Numbers of a flywheel by name, in SI, without what is None; those of a wheel have its name in front."""
    scalars = {}
    for field in fields(found):
        value = getattr(found, field.name)
        if field.name in UNITS and value is not None:
            scalars[f"machine_{field.name}"] = Scalar(value, UNITS[field.name])
        if field.name in WHEELS and value is not None:
            scalars |= {
                f"flywheel_{field.name}_{name}": Scalar(getattr(value, name), unit)
                for name, unit in WHEEL_UNITS.items()
            }
    return scalars


def flywheel_rows(mechanism: Mechanism, found: Flywheel) -> Rows:
    """Energies, inertia and sizes of a flywheel, in the units and the language of the reader."""
    return [*_energy_rows(found), *_inertia_rows(found), *_speed_rows(found), *_size_rows(mechanism, found)]


def mean_text(kind: Mean) -> str:
    """What the mean speed is."""
    return {
        "middle": _("half of greatest and least"),
        "time": _("turns over time"),
    }[kind]


def _energy_rows(found: Flywheel) -> Rows:
    turns = ngettext("{n} turn of the drive", "{n} turns of the drive", found.turns).format(n=found.turns)
    # weights take as much as they give: what is left is rounding
    idle = abs(found.work_of_loads) <= found.error
    between = _(
        "{greatest:.6g} J at {greatest_at:.5g} deg, {least:.6g} J at {least_at:.5g} deg, range {range:.6g} J"
    )
    return [
        (_("cycle"), _("{turns}, {time:.6g} s").format(turns=turns, time=found.time_of_cycle)),
        (
            _("mean speed"),
            _("{speed:.6g} rad/s ({what})").format(speed=found.mean_speed, what=mean_text(found.mean)),
        ),
        (
            _("work of the loads"),
            _("{work:.6g} J a cycle, to {error:.1e} J").format(
                work=0.0 if idle else found.work_of_loads, error=found.error
            ),
        ),
        (_("mean driving moment"), f"{0.0 if idle else found.driving_moment:.6g} N m"),
        (
            _("change of energy"),
            between.format(
                greatest=found.energy_greatest,
                greatest_at=degrees(found.greatest_at),
                least=found.energy_least,
                least_at=degrees(found.least_at),
                range=found.energy_greatest - found.energy_least,
            ),
        ),
    ]


def _inertia_rows(found: Flywheel) -> Rows:
    present = (_("inertia present"), f"{found.present:.6g} kg m²")
    if found.inertia is None or found.inertia_first_order is None:
        return [present]
    exact = _("{middle:.6g} kg m² exactly ({time:.6g} where the mean speed is turns over time)")
    if found.mean == "time":
        exact = _("{time:.6g} kg m² exactly")
    apart = _("{source:.6g} kg m² by the first-order formula ({difference:+.2%})").format(
        source=found.inertia_first_order,
        difference=(found.inertia_first_order - found.inertia) / abs(found.inertia) if found.inertia else 0.0,
    )
    added = f"{found.added:.6g} kg m²" if found.added else _("none is needed")
    return [
        (_("inertia needed"), exact.format(middle=found.inertia, time=found.inertia_in_time)),
        ("", _("{inertia:.6g} kg m² by Wittenbauer's diagram").format(inertia=found.inertia_by_tangents)),
        ("", apart),
        present,
        (_("flywheel"), added),
    ]


def _speed_rows(found: Flywheel) -> Rows:
    said = _("{least:.6g} to {greatest:.6g} rad/s, fluctuation {obtained:.6g}")
    return [
        (
            _("speed of the drive"),
            said.format(least=found.least_speed, greatest=found.greatest_speed, obtained=found.obtained),
        )
    ]


def _size_rows(mechanism: Mechanism, found: Flywheel) -> Rows:
    factor, unit = display_unit("m", mechanism.display.length)

    def size(wheel: Wheel) -> str:
        hole = _(", {inner:.4g} {unit} inside").format(inner=wheel.inner * factor, unit=unit)
        return _("{outer:.4g} {unit} across{hole}, {width:.4g} {unit} wide, {mass:.5g} kg").format(
            outer=wheel.outer * factor,
            hole=hole if wheel.inner else "",
            width=wheel.width * factor,
            unit=unit,
            mass=wheel.mass,
        )

    rows = []
    shapes = (
        (_("rim"), found.rim, found.source_rim, SOURCE_RIM),
        (_("disc"), found.disc, found.source_disc, SOURCE_DISC),
    )
    for label, exact, source, coefficient in shapes:
        if exact is not None:
            speed = _("{speed:.4g} m/s at its edge").format(speed=exact.rim_speed)
            bounded = " " + _("(admissible: the width follows)") if exact.bounded else ""
            rows.append((label, f"{size(exact)}, {speed}{bounded}"))
        if source is not None and found.added_first_order:
            error = source.inertia / found.added_first_order - 1
            said = _(
                "by the coefficient {coefficient}: {outer:.4g} {unit}, {mass:.5g} kg,"
                " really {inertia:.6g} kg m² ({error:+.1%})"
            )
            rows.append(
                (
                    "",
                    said.format(
                        coefficient=coefficient,
                        outer=source.outer * factor,
                        unit=unit,
                        mass=source.mass,
                        inertia=source.inertia,
                        error=error,
                    ),
                )
            )
    return rows
