"""The graph-analytic check: what the drawing gives beside what is integrated and what the closed forms give."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.analysis.graphic.diagrams import Diagram, Diagrams, diagrams
from centrode.errors import CentrodeError, Status
from centrode.model.mechanism import Mechanism

# Velocities by integrating the equations in Cauchy form: the second of three routes, where it applies.

STEPS = 100
"""Rows of an integration; of them only the last is requested."""

# the equations in symbols are heavy, and needed by this column alone
_integrated = functools.partial(importlib.import_module, "centrode.equations.integration")


def integrated_rates(mechanism: Mechanism, exact: xr.Dataset) -> Mapping[tuple[str, str], float]:
    """(quantity, link or point) -> its value at the only sample of a motion, by integration from the initial position.

    Speeds of points are lengths of their velocities. Empty where there are no such equations, where the integration
    does not get to the instant, or where this installation cannot integrate. Accelerations are not integrated.
    """
    stop = float(mechanism.motion_parameter.instants(exact)[0])
    try:
        course = _integrated().integrate(mechanism, "adaptive", steps=STEPS, stop=stop)
    except (ModuleNotFoundError, CentrodeError):
        return {}
    # it stopped before the instant: its last row is of another one
    if int(course["status"][-1]) != Status.OK:
        return {}
    last = course.isel(sample=-1)
    rates = {
        ("angular_velocity", name): float(last["angular_velocity"].sel(link=name))
        for name in mechanism.link_names
    }
    for name in mechanism.moving_points:
        rates["velocity", name] = float(np.hypot(*last["velocity"].sel(point=name).values))
    return rates


RATES = (("angular_velocity", "velocity"), ("angular_acceleration", "acceleration"))


@dataclass(frozen=True)
class CheckRow:
    """Row of the check: one number by every route, SI.

    Attributes
    ----------
    quantity : name of the variable in a motion
    name : link or point; of points the length of the vector
    graphic, integrated, closed : by the drawing, by integrating the equations (None where they do not apply), by
        the closed forms of the motion
    """

    quantity: str
    name: str
    unit: str
    graphic: float
    integrated: float | None
    closed: float

    @property
    def difference(self) -> float:
        """Value by the drawing, less that by the closed form."""
        return self.graphic - self.closed


@dataclass(frozen=True)
class GraphicCheck:
    """Both diagrams of an instant and the table that compares them with other routes."""

    diagrams: Diagrams
    rows: tuple[CheckRow, ...]

    def row(self, quantity: str, name: str) -> CheckRow:
        """The row of a link or a point; KeyError where there is none."""
        for row in self.rows:
            if (row.quantity, row.name) == (quantity, name):
                return row
        raise KeyError((quantity, name))


def graphic_check(
    mechanism: Mechanism,
    at: npt.ArrayLike,
    angle_step: float | str | None = None,
    length_step: float | str | None = None,
    scales: Mapping[str, float | str] | None = None,
) -> GraphicCheck:
    """Velocities and accelerations of an instant by the drawing, beside those of the motion.

    Parameters and failures are those of `diagrams`: a value of the drive or a time, a reading step of directions
    [rad] and of lengths on paper [m], scales of the drawings.
    """
    drawn = diagrams(mechanism, at, angle_step, length_step, scales)
    integrated = integrated_rates(mechanism, drawn.exact)
    pairs = zip(RATES, (drawn.velocity, drawn.acceleration), strict=True)
    rows = [row for names, diagram in pairs for row in _rows(drawn, diagram, names, integrated)]
    return GraphicCheck(drawn, tuple(rows))


def _rows(
    found: Diagrams,
    diagram: Diagram,
    names: tuple[str, str],
    integrated: Mapping[tuple[str, str], float],
) -> Iterator[CheckRow]:
    turning, moving = names
    for link in found.mechanism.link_names:
        exact = float(found.exact[turning].sel(link=link)[0])
        unit = "rad/s" if diagram.order == 1 else "rad/s^2"
        # no -0.0 in a table
        turn = diagram.turns[link] + 0.0
        yield CheckRow(turning, link, unit, turn, integrated.get((turning, link)), exact)
    # a step on paper [m] in millimetres, times what a millimetre stands for
    grain = 1e3 * (found.board.paper_step or 0.0) * diagram.scale
    for point in found.mechanism.moving_points:
        exact = float(np.hypot(*found.exact[moving].sel(point=point).values[0]))
        length = abs(diagram.images[point])
        read = grain * round(length / grain) if grain else length
        yield CheckRow(moving, point, diagram.unit, read, integrated.get((moving, point)), exact)
