"""What is said of a simulation: what drove it, how it ended, its speeds and energies, and the steady regime."""

from __future__ import annotations

from math import tau
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from centrode.dynamics.simulation.steady_state import Regime
from centrode.locale import _, ngettext
from centrode.model.mechanism import Mechanism
from centrode.study.wording import value_text

if TYPE_CHECKING:
    import xarray

Rows: TypeAlias = list[tuple[str, str]]
NOTHING = 1e-6
"""A multiplier below this is rounding of the map's differences."""
SHOWN = 8
"""Occasions that are told one by one."""


def simulation_rows(mechanism: Mechanism, found: xarray.Dataset) -> Rows:
    """What moved, how it ended, speeds, works and energies, in the language and the units of the reader."""
    speed = found["drive_speed"].to_numpy()
    unit = str(found["drive_speed"].attrs["units"])
    rows = [
        (_("drives"), ", ".join(found["drive"].to_numpy())),
        (_("driven by"), _driven_by(mechanism, found)),
        (_("scheme"), _scheme(found)),
        (_("ended"), _ended(mechanism, found)),
        (_("turned") if mechanism.drives[0].kind == "angle" else _("moved"), _turned(mechanism, found)),
        (
            _("speed of the drive"),
            _("{least:.6g} to {greatest:.6g} {unit}, {last:.6g} {unit} at the end").format(
                least=speed.min(), greatest=speed.max(), last=speed[-1], unit=unit
            ),
        ),
        (_("works"), _works(found)),
        (_("energies"), _energies(found)),
    ]
    return rows + _occasion_rows(mechanism, found)


def regime_rows(mechanism: Mechanism, regime: Regime) -> Rows:
    """The steady regime: period, speeds and where they lie, fluctuation, how fast deviations die away.

    Where any speed would come back, as of a conservative machine, it is a periodic motion and no steady regime.
    """
    turns = ngettext("{n} turn of the drive", "{n} turns of the drive", regime.turns).format(n=regime.turns)
    where = _("{speed:.6g} rad/s with the drive at {value}")
    least = where.format(
        speed=regime.least_speed, value=value_text(regime.least_at, "rad", mechanism.display)
    )
    most = where.format(
        speed=regime.greatest_speed, value=value_text(regime.greatest_at, "rad", mechanism.display)
    )
    dies = _("{share:.3g} of a deviation is left after a period").format(share=regime.multiplier)
    if abs(regime.multiplier) < NOTHING:
        dies = _("nothing of a deviation is left after a period")
    if regime.multiplier > 1.0:
        dies = _("a deviation of the speed does not die away")
    if regime.indifferent:
        dies = _("any speed comes back: it runs up to none")
    return [
        (
            _("periodic motion") if regime.indifferent else _("steady regime"),
            _("{turns}, {time:.6g} s").format(turns=turns, time=regime.time),
        ),
        (_("least speed"), least),
        (_("greatest speed"), most),
        (_("mean speed"), _("{speed:.6g} rad/s (turns over time)").format(speed=regime.mean_speed)),
        (_("fluctuation"), f"{regime.fluctuation:.6g}"),
        (_("mean driving moment"), f"{regime.driving_moment:.6g} N m"),
        (_("stability"), dies),
    ]


def _driven_by(mechanism: Mechanism, found: xarray.Dataset) -> str:
    law = str(found.attrs["driving"])
    unit = str(found["driving_moment"].attrs["units"])
    return _("nothing") if law == "0" else f"{law} {unit}"


def _scheme(found: xarray.Dataset) -> str:
    said = {
        "adaptive": _("adaptive (DOP853)"),
        "stiff": _("for stiff laws (Radau)"),
        "adaptive, then stiff": _("adaptive (DOP853), then for stiff laws (Radau)"),
        "runge-kutta-4": _("Runge-Kutta of order 4, fixed steps"),
    }[found.attrs["scheme"]]
    if found.attrs["executor"] == "machine code":
        said = _("{scheme}, machine code").format(scheme=said)
    count = int(found.attrs["evaluations"])
    computed = ngettext("{n} acceleration computed", "{n} accelerations computed", count).format(n=count)
    return f"{said}, {computed}"


def _ended(mechanism: Mechanism, found: xarray.Dataset) -> str:
    time = float(found["time"].to_numpy()[-1])
    return {
        "duration": _("after {time:.6g} s"),
        "turns": _("after the turns asked for, in {time:.6g} s"),
        "limit": _("at a limit of the mechanism, after {time:.6g} s"),
        "change point": _("at a change point, where its path ends, after {time:.6g} s"),
        "standstill": _("it stands still; {time:.6g} s are shown"),
        "interrupted": _("interrupted at {time:.6g} s"),
    }[found.attrs["ended"]].format(time=time)


def _turned(mechanism: Mechanism, found: xarray.Dataset) -> str:
    unit = str(found["turned"].attrs["units"])
    turned = float(found["turned"].to_numpy()[-1])
    text = value_text(turned, unit, mechanism.display)
    if unit != "rad":
        return text
    return _("{value}, {turns:.6g} turns").format(value=text, turns=turned / tau)


def _works(found: xarray.Dataset) -> str:
    names = ("work_of_drive", "work_of_friction", "work_of_other_loads")
    drive, friction, others = (float(found[name].to_numpy()[-1]) for name in names)
    return _("drive {drive:.6g} J, friction {friction:.6g} J, other loads {others:.6g} J").format(
        drive=drive, friction=friction, others=others
    )


def _energies(found: xarray.Dataset) -> str:
    kinetic, potential = (found[name].to_numpy() for name in ("kinetic_energy", "potential_energy"))
    return _(
        "kinetic {kinetic:.6g} J at the end, potential {potential:+.6g} J, residual {residual:.1e} J"
    ).format(
        kinetic=float(kinetic[-1]),
        potential=float(potential[-1] - potential[0]) + 0.0,
        residual=float(np.max(np.abs(found["energy_residual"].to_numpy()))),
    )


def _occasion_rows(mechanism: Mechanism, found: xarray.Dataset) -> Rows:
    words = {
        "turns_back": _("it turns back"),
        "sticks": _("it sticks"),
        "breaks_loose": _("it breaks loose"),
        "limit": _("it comes to a limit"),
        "change_point": _("it comes to a change point"),
        "standstill": _("it comes to a standstill"),
    }
    names = str(found["occasion_kind"].attrs["flag_meanings"]).split()
    kinds = [names[k] for k in found["occasion_kind"].to_numpy().tolist()]
    unit = str(found["occasion_value"].attrs["units"])
    times, values = (found[name].to_numpy().tolist() for name in ("occasion_time", "occasion_value"))
    said = [
        (
            words[kind],
            _("at {time:.6g} s, drive at {value}").format(
                time=time, value=value_text(value, unit, mechanism.display)
            ),
        )
        for kind, time, value in zip(kinds[:SHOWN], times, values, strict=False)
    ]
    if len(kinds) > SHOWN:
        said.append(("", _("and {n} more").format(n=len(kinds) - SHOWN)))
    return said
