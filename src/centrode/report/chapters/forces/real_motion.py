"""The chapter of the real motion: speed and acceleration of the drive in steady motion, and of what follows it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from centrode.locale import _
from centrode.present.forces.machine_figures import machine_figures
from centrode.render.document.blocks import Block, Chapter, Formula, Paragraph, Section, Table, shown
from centrode.render.document.formulas import factor, in_si, squared, with_unit
from centrode.report.chapters.forces.absent import without_machine
from centrode.report.chapters.forces.places import few, titles
from centrode.report.chapters.forces.results import has_forces, machine_of, steady_at_instants
from centrode.report.chapters.forces.tables import Column, over_samples
from centrode.report.telling import pictures

if TYPE_CHECKING:
    import xarray as xr

    from centrode.report.study import ReportStudy

COURSE = (
    ("turned", "phi"),
    ("drive_speed", "omega"),
    ("drive_acceleration", "epsilon"),
    ("drive_speed_first_order", "omega_1"),
    ("drive_acceleration_first_order", "epsilon_1"),
)
OMEGA = (
    "omega",
    "omega_upright(m) + frac(Delta T_upright(I) - 1/2 (Delta T_(upright(I), max) + Delta T_(upright(I), min)),"
    " omega_upright(m) J_upright(I))",
)
EPSILON = (
    "epsilon",
    'frac(M_upright(c) + M_upright(d), J_upright(I) + J_upright("II"))'
    ' - frac(omega^2 J\'_upright("II"), 2 (J_upright(I) + J_upright("II")))',
)


def real_motion_chapter(study: ReportStudy) -> Chapter | None:
    """Real speed of the drive, and real velocities and accelerations at the instants."""
    if not has_forces(study) or study.mechanism.machine is None:
        return None
    return without_machine(study, "real-motion", _("Real motion")) or _made(study)


def _made(study: ReportStudy) -> Chapter:
    sections = [Section("", _meaning())]
    steady = steady_at_instants(study)
    sections += [
        Section(title, tuple(_at(study, steady.isel(sample=k)))) for k, title in enumerate(titles(study))
    ]
    sections.append(Section(_("Over the cycle"), (_course(study),)))
    sections.append(Section(_("Figures"), tuple(_figures(study))))
    return Chapter("real-motion", _("Real motion"), tuple(sections))


def _meaning() -> tuple[Block, ...]:
    text = _(
        "With the flywheel the speed $omega$ of the drive follows from the energy equation, its acceleration $epsilon$"
        " from the equation of motion. To first order, as courses have it:"
    )
    then = _("The numbers below are exact; those to first order ($omega_1$, $epsilon_1$) stand beside them.")
    links = _(
        "Velocities and accelerations of the links follow with the derivatives by the angle of the drive:"
    )
    lines = (("arrow(v)", "arrow(r)' omega"), ("arrow(a)", "arrow(r)'' omega^2 + arrow(r)' epsilon"))
    return Paragraph(text), Formula((OMEGA, EPSILON)), Paragraph(then), Paragraph(links), Formula(lines)


def _at(study: ReportStudy, here: xr.Dataset) -> list[Block]:
    """The acceleration with its numbers, then links and points."""
    numbers, inertia = in_si(study.numbers), float(here.attrs["inertia"])
    own = float(here["inertia_of_links"])
    speed, bend = float(here["drive_speed"]), float(here["drive_acceleration"])
    moment = float(here["moment_of_loads"] + here["driving_moment"])
    slope = float(here["inertia_slope_of_links"])
    below = numbers.math(inertia + own)
    right = (
        f"frac({numbers.math(moment)}, {below}) - "
        f"frac({squared(numbers, speed)} dot.op {factor(numbers, slope)}, 2 dot.op {below})"
    )
    lines = (
        ("omega", with_unit(numbers, speed, "rad/s")),
        ("epsilon", right, with_unit(numbers, bend, "rad/s^2")),
    )
    return [Formula(lines), *_links(study, here), *_points(study, here)]


def _links(study: ReportStudy, here: xr.Dataset) -> list[Block]:
    if not study.is_planar:
        return []
    rows = [
        [float(here[name].sel(link=link)) for name in ("angular_velocity", "angular_acceleration")]
        for link in study.mechanism.links
    ]
    units = ("rad/s", "rad/s^2")
    values = np.array(rows)
    heads = (
        _("link"),
        *(study.numbers.head(f"${s}$", u) for s, u in zip(("omega", "epsilon"), units, strict=True)),
    )
    return [_named(study, list(study.mechanism.links), values, units, heads, _("Links"))]


def _points(study: ReportStudy, here: xr.Dataset) -> list[Block]:
    points = list(study.mechanism.moving_points)
    axes = here["axis"].to_numpy().tolist()
    rows: list[list[float]] = []
    units: list[str] = []
    heads = [_("point")]
    for name, symbol in (("velocity", "v"), ("acceleration", "a")):
        unit = str(here[name].attrs["units"])
        for axis in axes:
            heads.append(study.numbers.head(f"${symbol}_{axis}$", unit))
            units.append(unit)
            rows.append([float(here[name].sel(point=point, axis=axis)) for point in points])
    return [_named(study, points, np.array(rows).T, units, heads, _("Points"))]


def _named(
    study: ReportStudy,
    names: Sequence[str],
    values: np.ndarray,
    units: Sequence[str],
    heads: Sequence[str],
    caption: str,
) -> Table:
    """Rows of named things, columns of quantities."""
    columns = [tuple(shown(name) for name in names)]
    for k, unit in enumerate(units):
        least = 1e-12 * float(np.nanmax(np.abs(values[:, k]), initial=0.0))
        columns.append(study.numbers.column(values[:, k], unit, least))
    return Table(tuple(heads), tuple(zip(*columns, strict=True)), caption, (False,) + (True,) * len(units))


def _course(study: ReportStudy) -> Table:
    steady = machine_of(study).steady
    columns = [
        Column(f"${symbol}$", str(steady[name].attrs["units"]), steady[name].to_numpy())
        for name, symbol in COURSE
    ]
    caption = _("Speed and acceleration of the drive over the cycle")
    return over_samples(study.numbers, columns, few(steady.sizes["sample"]), caption)


def _figures(study: ReportStudy) -> list[Block]:
    captions = {
        "drive-speed": _("Speed and acceleration of the drive, to first order dashed"),
        "real-angular-velocities": _("Real angular velocities of the links"),
        "real-angular-accelerations": _("Real angular accelerations of the links"),
        "real-velocities": _("Real velocities of the points"),
        "real-accelerations": _("Real accelerations of the points"),
    }
    drawn = study.once("machine figures", lambda: machine_figures(study.mechanism, machine_of(study).steady))
    return [*pictures(drawn, captions)]
