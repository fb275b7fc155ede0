"""A graph-analytic check in words and tables: scales, vector equations, triangles with their sines, four routes."""

from __future__ import annotations

import math

from centrode.analysis.graphic.checks import CheckRow, GraphicCheck
from centrode.analysis.graphic.diagrams import Diagrams
from centrode.analysis.graphic.stage import ConstructionStep, DrawingBoard
from centrode.locale import _
from centrode.model.mechanism import Display
from centrode.quantities import QUANTITIES, display_unit

NOTHING = "-"
NONE = 1e-14
"""What is smaller than this part of the greatest number of its kind is nothing: rounding of the drawing."""
INTEGRATED = 1e-10
"""The same of what is integrated, which is as exact as the tolerance of a step."""
ALIKE = 1e-15
"""Differences below this part of the greatest number are none."""


def graphic_rows(check: GraphicCheck) -> list[tuple[str, ...]]:
    """The table of a check in the units of the display, its heads first."""
    heads = (_("quantity"), _("unit"), _("drawn"), _("integrated"), _("closed form"), _("difference"))
    display = check.diagrams.mechanism.display
    greatest: dict[str, float] = {}
    for row in check.rows:
        greatest[row.quantity] = max(greatest.get(row.quantity, 0.0), abs(row.closed), abs(row.graphic))
    return [heads, *(_row(row, display, greatest[row.quantity]) for row in check.rows)]


def _row(row: CheckRow, display: Display, greatest: float) -> tuple[str, ...]:
    factor, unit = display_unit(row.unit, display.length, display.angle)
    symbol = f"{QUANTITIES[row.quantity].symbol}_{row.name}"
    if not row.quantity.startswith("angular"):
        symbol = f"|{symbol}|"
    greatest *= factor
    # of a mechanism at rest the integrated rates are rounding of its lengths and turns
    floor = INTEGRATED * (greatest or factor)
    integrated = NOTHING if row.integrated is None else _number(factor * row.integrated, floor)
    values = (
        _number(factor * row.graphic, NONE * greatest),
        integrated,
        _number(factor * row.closed, NONE * greatest),
    )
    difference = factor * row.difference
    return symbol, unit, *values, "0" if abs(difference) <= ALIKE * greatest else f"{difference:.1e}"


def graphic_csv(check: GraphicCheck) -> str:
    """The table as CSV in SI, every number in full."""
    lines = ["quantity,name,unit,drawing,integrated,closed_form,difference"]
    for row in check.rows:
        integrated = "" if row.integrated is None else repr(row.integrated)
        numbers = [repr(float(row.graphic)), integrated, repr(row.closed), repr(float(row.difference))]
        name = f'"{row.name}"' if "," in row.name else row.name
        lines.append(",".join([row.quantity, name, row.unit, *numbers]))
    return "\n".join(lines) + "\n"


def graphic_about(check: GraphicCheck) -> list[tuple[str, str]]:
    """Scales, how finely was read, and the instant centres."""
    found = check.diagrams
    length, unit = display_unit("m", found.mechanism.display.length, found.mechanism.display.angle)
    rows = [
        (_("scales"), ", ".join(_scales(found))),
        (_("read"), _reading(found.board)),
    ]
    label = _("instant centres")
    none = NONE * length * max((abs(place) for place in found.places.values()), default=0.0)
    for link, centre in found.centres.items():
        if centre is None:
            text = _("{link}: at infinity, it translates").format(link=link)
        else:
            place = f"({_number(length * centre.real, none)}, {_number(length * centre.imag, none)}) {unit}"
            apart = [
                f"P{point} = {_number(length * found.reach(link, point), none)}"
                for point in found.mechanism.links[link].coordinates
            ]
            text = f"{link}: {place}, {', '.join(apart[:3])} {unit}"
        rows.append((label, text))
        label = ""
    return rows


def _scales(found: Diagrams) -> list[str]:
    display = found.mechanism.display
    listed = []
    for symbol, unit, scale in (
        ("μ_l", "m", found.scale),
        ("μ_v", "m/s", found.velocity.scale),
        ("μ_a", "m/s^2", found.acceleration.scale),
    ):
        factor, shown = display_unit(unit, display.length, display.angle)
        listed.append(
            _("{symbol} = {value:g} {unit} per mm").format(symbol=symbol, value=factor * scale, unit=shown)
        )
    return listed


def _reading(board: DrawingBoard) -> str:
    texts = []
    if board.angle_step is not None:
        texts.append(_("directions to {step:g} deg").format(step=math.degrees(board.angle_step)))
    if board.paper_step is not None:
        texts.append(_("lengths on paper to {step:g} mm").format(step=1e3 * board.paper_step))
    return ", ".join(texts) or _("exactly")


def graphic_steps(check: GraphicCheck) -> list[str]:
    """What was done: vector equations, trials and sines, velocities first."""
    lines: list[str] = []
    for diagram in (check.diagrams.velocity, check.diagrams.acceleration):
        lines += ["", _("velocities") if diagram.order == 1 else _("accelerations")]
        for step in diagram.steps:
            lines.append(f"  {step.group}")
            told = [*step.equations, *trial_lines(step, diagram.order), *sine_lines(step)]
            lines += [f"    {line}" for line in told]
    return lines


def sine_lines(step: ConstructionStep) -> list[str]:
    """The law of sines with its numbers, as a person writes it: all sides, then each ratio."""
    if step.triangle is None:
        return []
    names, sides, angles = step.triangle.names, step.triangle.sides, step.triangle.angles
    shown = [f"sin {_degrees(angle)}" for angle in angles]
    left = " : ".join(f"|{name}|" for name in names)
    lines = [f"{left} = {' : '.join(shown)}"]
    sines = [math.sin(angle) for angle in angles]
    for k in (1, 2):
        ratio = f"{sines[k]:.4f}/{sines[0]:.4f} = {sides[k] / sides[0]:.4f}"
        lines.append(f"|{names[k]}|/|{names[0]}| = {shown[k]}/{shown[0]} = {ratio}")
    known = names[0].removeprefix("v_")
    for k in (1, 2):
        arm = names[k].removeprefix("v_")
        if arm != names[k] and arm.endswith(known) and arm != known:
            # the link's triangle with its instant centre has the same angles: its sides are square to the velocities
            ratio = f"{sines[0]:.4f}/{sines[k]:.4f} = {sides[0] / sides[k]:.4f}"
            lines.append(f"P{known}/{arm} = {shown[0]}/{shown[k]} = {ratio}")
    return lines


def trial_lines(step: ConstructionStep, order: int) -> list[str]:
    """The false position: what was tried, what was amiss, what fits."""
    if step.trial is None:
        return []
    trial, symbol = step.trial, "ω" if order == 1 else "ε"
    turned = [f"{symbol}_{link}" for link in trial.links]
    lines = [
        _("false position: {links} tried, {cut} checked").format(
            links=", ".join(turned), cut=", ".join(trial.checked)
        )
    ]
    rate = NONE * max(abs(x) for values in (*trial.values, trial.found) for x in values)
    apart = NONE * max(abs(x) for misfits in trial.misfits for x in misfits)
    for values, misfits in zip(trial.values, trial.misfits, strict=True):
        tried = ", ".join(f"{name} = {_number(x, rate)}" for name, x in zip(turned, values, strict=True))
        amiss = ", ".join(_number(x, apart) for x in misfits)
        lines.append(_("{tried}: amiss by {amiss}").format(tried=tried, amiss=amiss))
    found = ", ".join(f"{name} = {_number(x, rate)}" for name, x in zip(turned, trial.found, strict=True))
    return [*lines, _("so {found}").format(found=found)]


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.5g}°"


def _number(x: float, none: float) -> str:
    """Six figures; what is not greater than `none`, as nothing."""
    return f"{x:.6g}" if abs(x) > none else "0"
