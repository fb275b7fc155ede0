"""The chapter of the simulation: the motion that loads, friction and a motor make, and its steady regime."""

from __future__ import annotations

from math import tau
from typing import TYPE_CHECKING

import numpy as np

from centrode.dynamics.simulation.steady_state import steady_regime
from centrode.errors import CentrodeError
from centrode.locale import _
from centrode.present.forces.simulation_figures import simulation_figures
from centrode.render.document.blocks import Chapter, Check, Formula, Paragraph, Section, Table
from centrode.report.chapters.forces.results import has_forces, simulated
from centrode.report.chapters.forces.tables import Column, over_samples
from centrode.report.telling import facts, measured, pictures
from centrode.study.forces.simulating import regime_rows, simulation_rows
from centrode.views.columns import rows_shown

if TYPE_CHECKING:
    from centrode.report.study import ReportStudy

COURSE = (
    ("time", "t", "s"),
    ("turned", "phi", ""),
    ("drive_speed", "dot(q)", ""),
    ("drive_acceleration", "dot.double(q)", ""),
    ("driving_moment", "M_upright(d)", ""),
    ("kinetic_energy", "T", ""),
)
EVALUATIONS = 12
"""Accelerations that a step of the adaptive scheme computes at least."""


def simulation_chapter(study: ReportStudy) -> Chapter | None:
    """The motion under loads and a drive, where the description has a `[simulation]`."""
    if not has_forces(study) or study.mechanism.simulation is None:
        return None
    mechanism, found = study.mechanism, simulated(study)
    text = _(
        "The drive is not led: its motion follows from the reduced inertia and the reduced moments of drive and loads."
    )
    line = ("J dot.double(q) + 1/2 J' dot(q)^2", "M_upright(d) + M")
    first = facts(study.numbers, simulation_rows(mechanism, found))
    sections = [
        Section("", (Paragraph(text), Formula((line,)), first, *_energy(study))),
        Section(_("Over time"), (_course(study),)),
    ]
    sections += _regime(study)
    figures = simulation_figures(mechanism, found)
    captions = {
        "simulation-speed": _("Speed and acceleration of the drive, and the moments on it, over time"),
        "simulation-phase": _("Speed over the value of the drive"),
        "simulation-energies": _("Energies and works over time"),
    }
    sections.append(Section(_("Figures"), tuple(pictures(figures, captions))))
    return Chapter("simulation", _("Motion under loads"), tuple(sections))


def _course(study: ReportStudy) -> Table:
    found = simulated(study)
    columns = [
        Column(f"${symbol}$", unit or str(found[name].attrs["units"]), found[name].to_numpy())
        for name, symbol, unit in COURSE
        if name in found.variables
    ]
    return over_samples(
        study.numbers, columns, rows_shown(found.sizes["sample"]), _("The motion at even steps of time")
    )


def _energy(study: ReportStudy) -> list[Check]:
    """What the works do not account for; the adaptive schemes promise their tolerance at every step."""
    found, settings = simulated(study), study.mechanism.simulation
    if settings is None or found.attrs["scheme"] == "runge-kutta-4":
        return []
    works = [
        np.abs(found[name].to_numpy()).max()
        for name in ("work_of_drive", "work_of_friction", "kinetic_energy")
    ]
    steps = int(found.attrs["evaluations"]) / EVALUATIONS
    text = _("Works and energies do not account for {share} of the greatest of them, over the whole motion.")
    residual = float(np.abs(found["energy_residual"].to_numpy()).max())
    return [measured(text, residual, float(max(works)), steps * settings.tolerance)]


def _regime(study: ReportStudy) -> list[Section]:
    """The steady regime, or the periodic motion, of a drive that has turned all the way round."""
    mechanism, found = study.mechanism, simulated(study)
    if not mechanism.motion_parameter.turns or found.attrs["ended"] not in ("duration", "turns"):
        return []
    if not float(found["turned"].to_numpy().max()) >= tau:
        return []
    try:
        regime = study.once("regime", lambda: steady_regime(mechanism))
    except CentrodeError as failure:
        none = Paragraph(_("None is found: {reason}.").format(reason=failure.what))
        return [Section(_("Steady regime"), (none,))]
    title = _("Periodic motion") if regime.indifferent else _("Steady regime")
    return [Section(title, (facts(study.numbers, regime_rows(mechanism, regime)),))]
