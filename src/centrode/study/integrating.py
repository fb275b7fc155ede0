"""What is said of an integrated motion: rows of a label and a text, and why it stopped."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from centrode.errors import Status
from centrode.kinematics.motion import motion
from centrode.locale import _, ngettext
from centrode.model.labels import constraint_name
from centrode.model.mechanism import Mechanism
from centrode.quantities import status_word
from centrode.study.wording import value_text

if TYPE_CHECKING:
    import xarray as xr

Rows: TypeAlias = list[tuple[str, str]]

RETURNS = 1e-9
"""A motion in closed form whose ends are nearer than this comes back: rounding stays far below, designs far above."""


def closed_motion(mechanism: Mechanism, integration: xr.Dataset, samples: int = 361) -> xr.Dataset:
    """The motion in closed form over the range of an integrated one, for curves to be compared with."""
    instants = mechanism.motion_parameter.instants(integration)
    first, last = (float(instants[end]) for end in (0, -1))
    return motion(mechanism, samples, start=first, stop=last)


def integration_rows(mechanism: Mechanism, integration: xr.Dataset) -> Rows:
    """Method, range, rows, where it stopped, greatest drift and differences, whether the last row repeats the first."""
    status = integration["status"].to_numpy()
    counts = [(Status(code), int(np.sum(status == code))) for code in np.unique(status)]
    said = ", ".join(f"{status_word(which)} {number}" for which, number in counts)
    times = integration["time"].to_numpy()
    shown = [value_text(float(times[end]) + 0.0, "s", mechanism.display) for end in (0, -1)]
    return [
        (_("method"), _method(integration)),
        (_("range"), _("{first} to {last}").format(first=shown[0], last=shown[1])),
        (_("rows"), f"{len(status)}: {said}"),
        (_("stops"), integration_failure(mechanism, integration) or _("nowhere")),
        (_("closed forms"), _events(mechanism, integration)),
        (_("greatest drift"), _drift(integration)),
        (_("greatest difference"), _difference(mechanism, integration)),
        (_("last row"), _return(integration)),
    ]


def _method(integration: xr.Dataset) -> str:
    told, times = integration.attrs, integration["time"].to_numpy()
    taken = int(told["steps_taken"])
    if told["method"] == "rk4":
        step = abs(float(times[-1] - times[0])) / max(taken, 1)
        return ngettext(
            "Runge-Kutta of fourth order, {n} step of {step:.6g} s",
            "Runge-Kutta of fourth order, {n} steps of {step:.6g} s",
            taken,
        ).format(n=taken, step=step)
    return ngettext(
        "Dormand-Prince of eighth order, {n} step, tolerance {tolerance:.1e}",
        "Dormand-Prince of eighth order, {n} steps, tolerance {tolerance:.1e}",
        taken,
    ).format(n=taken, tolerance=told["tolerance"])


def integration_failure(mechanism: Mechanism, integration: xr.Dataset) -> str | None:
    """Where and why the integration stopped, in a sentence; None where it did not."""
    stop, lost = integration.attrs["stop_time"], integration.attrs["lost_time"]
    sentences = []
    if np.isfinite(lost):
        sentences.append(
            _("fixed steps leave the mechanism at {time}: ask for more steps").format(
                time=_at(mechanism, integration, lost)
            )
        )
    if np.isfinite(stop):
        sentences.append(
            _("at {time} the determinant of the equations is zero, so they give no velocities").format(
                time=_at(mechanism, integration, stop)
            )
        )
    return "; ".join(sentences) or None


def _at(mechanism: Mechanism, integration: xr.Dataset, time: float) -> str:
    """A time, with the value of the only drive where it is even."""
    text = value_text(time, "s", mechanism.display)
    parameter = mechanism.motion_parameter
    if not parameter.is_uniform:
        return text
    value = parameter.value_at(time, float(parameter.values(integration)[0]))
    return _("{time} ({drive} at {value})").format(
        time=text,
        drive=mechanism.drives[0].id,
        value=value_text(value, parameter.variable.unit, mechanism.display),
    )


def _events(mechanism: Mechanism, integration: xr.Dataset) -> str:
    """Limits and change points of the closed forms in the range, each once."""
    unit = str(integration["event_value"].attrs["units"])
    words = (_("limit at {value}"), _("change point at {value}"))
    places = zip(integration["event_value"].to_numpy(), integration["event_kind"].to_numpy(), strict=True)
    told = [words[kind].format(value=value_text(float(at), unit, mechanism.display)) for at, kind in places]
    return "; ".join(dict.fromkeys(told)) or _("nothing that stops it")


def _drift(integration: xr.Dataset) -> str:
    drift = np.abs(integration["drift"].to_numpy())
    if not np.isfinite(drift).any():
        return _("none")
    _row, column = np.unravel_index(int(np.nanargmax(drift)), drift.shape)
    return _("{value:.1e} of the greatest length ({constraint})").format(
        value=float(np.nanmax(drift)),
        constraint=constraint_name(str(integration["constraint"].to_numpy()[column])),
    )


def _small(value: float) -> str:
    """Two figures of a small number; nothing as nothing."""
    return f"{value:.1e}" if value else "0"


def _difference(mechanism: Mechanism, integration: xr.Dataset) -> str:
    """Worst angle and worst place against the closed forms."""
    found = []
    for name, dimension in (("angle_difference", "link"), ("position_difference", "point")):
        values = np.abs(integration[name].to_numpy())
        if not np.isfinite(values).any():
            continue
        _row, column = np.unravel_index(int(np.nanargmax(values)), values.shape)
        unit = str(integration[name].attrs["units"])
        worst = float(np.nanmax(values))
        named = f" ({integration[dimension].to_numpy()[column]})" if worst else ""
        found.append(f"{_small(worst)} {unit}{named}")
    return ", ".join(found) or _("none")


def _return(integration: xr.Dataset) -> str:
    own, closed = integration.attrs["return_difference"], integration.attrs["closed_return_difference"]
    if not np.isfinite(own):
        return _("not reached")
    if closed > RETURNS:
        return _("does not repeat the first: {own:.3g} apart, {closed:.3g} in closed form").format(
            own=own, closed=closed
        )
    return _("repeats the first to {own}").format(own=_small(own)) if own else _("repeats the first")
