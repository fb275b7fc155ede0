"""Laws of motion beside each other for the first rise of a cam, in words."""

from __future__ import annotations

import math

import xarray as xr

from centrode.cams.followers.motion import cam_laws, motion_names
from centrode.locale import _, mark
from centrode.model.follower_cam import PlateCam
from centrode.quantities import QUANTITIES
from centrode.study.cams.said import Asked, CamPart, Table, Units

CURVES = (
    mark("uniform"), mark("harmonic"), mark("cycloidal"), mark("modified sine"),
    mark("modified trapezoid"), mark("dwell"), mark("polynomial"), mark("b-spline"),
)  # fmt: skip
"""Names of the curves, in which descriptions give them."""
JUMPS = (mark("–"), mark("velocity"), mark("acceleration"), mark("jerk"), mark("fourth derivative"))


def laws_part(cam: PlateCam, asked: Asked) -> CamPart | None:
    """The comparison; nothing where it is not asked for."""
    if not asked.laws:
        return None
    found, units = cam_laws(cam), Units(cam)
    unit = "rad" if cam.swings else "m"
    told = _("{rise} over {angle}: segment {number}, {curve}").format(
        rise=units.text(found.attrs["rise"], unit),
        angle=units.angle(found.attrs["angle"]),
        number=found.attrs["segment"] + 1,
        curve=_(found.attrs["curve"]),
    )
    tables = (_coefficients(found), _sizes(cam, found))
    return CamPart(_("Laws of motion for one rise"), [(_("rise"), told)], {}, {"cam-laws": found}, tables)


def _coefficients(found: xr.Dataset) -> Table:
    header = (_("curve"), "C_v", "C_a", "C_j", "C_T", _("jumps at the ends or inside"))
    lines = []
    for name in found["law"].to_numpy().tolist():
        one = found.sel(law=name)
        jump = int(one["first_jump"])
        # A derivative above one that jumps has no bound there, however small it is between.
        peaks = [
            f"{float(one['peak_coefficient'].sel(derivative=k)):.5g}"
            + (_(", ∞ there") if 0 < jump < k else "")
            for k in (1, 2, 3)
        ]
        lines.append((_(name), *peaks, f"{float(one['torque_coefficient']):.5g}", _(JUMPS[jump])))
    heading = _("Peak coefficients: greatest v, a, j in parts of h/β, h/β², h/β³; of v a in parts of h²/β³")
    return Table(heading, header, lines, named=True)


def _sizes(cam: PlateCam, found: xr.Dataset) -> Table:
    units = Units(cam)
    rise, angle, speed = abs(found.attrs["rise"]), found.attrs["angle"], found.attrs.get("speed")
    by_angle, in_time = motion_names(cam.swings)
    names = by_angle[1:4] if speed is None else in_time
    shown = [(QUANTITIES[name].symbol, *units.shown(QUANTITIES[name].unit)) for name in names]
    header = (_("curve"), *(symbol if unit == "1" else f"{symbol}, {unit}" for symbol, _f, unit in shown))
    lines = []
    for name in found["law"].to_numpy().tolist():
        peaks = found["peak_coefficient"].sel(law=name)
        sizes = [
            float(peaks.sel(derivative=k)) * rise * math.pow((speed or 1.0) / angle, k) * factor
            for k, (_symbol, factor, _unit) in enumerate(shown, 1)
        ]
        lines.append((_(name), *(f"{size:.6g}" for size in sizes)))
    return Table(_("Greatest sizes in this rise"), header, lines, named=True)
