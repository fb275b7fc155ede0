"""The path of a cam's roller in words: law, sizes, pressure angle, stall, ends."""

from __future__ import annotations

import math

import numpy as np
import xarray as xr

from centrode.cams.cam import cam_routes, dataset_of_path
from centrode.cams.path_series import half_path, path_of
from centrode.cams.roller_path import (
    RollerPath,
    angles_of,
    curvature_extremes,
    ends_of,
    pressure_extremes,
    radius_extremes,
    stalls_of,
)
from centrode.errors import CentrodeError
from centrode.locale import _, ngettext
from centrode.model.cam import Cam
from centrode.sheets.sheet import Scalar
from centrode.study.cams.parts import Asked, CamPart, CamTable, Rows, Units

FURTHER = math.tau
"""Angle [rad] up to which a stall beyond the range is looked for."""


def path_part(cam: Cam, asked: Asked) -> CamPart:
    """The path by series expanded anew step by step."""
    phi = angles_of(cam, asked.samples)
    path = path_of(cam)
    dataset = dataset_of_path(cam, path, phi)
    rows, scalars = _sizes(cam, path)
    stall, told, failures = _stall(cam, path)
    scalars |= stall
    ends, kink = _ends(cam, path)
    drawn, worst = _drawn(dataset)
    return CamPart(
        _("Path of the roller's centre"),
        [*_law(cam), *rows, told, ends, drawn],
        scalars | kink | worst,
        {"cam-path": dataset},
        failures=failures,
        objects={"path": path},
    )


def _law(cam: Cam) -> Rows:
    given, units = cam.curvature, Units(cam)
    k0 = units.text(given.k0 or math.nan, "1/m", 9)
    slope = units.text(given.k1 or 0.0, "1/m/rad", 9)
    law = {
        "constant": f"K = {k0}",
        "exponential": f"K = k0 exp(k1 φ), k0 = {k0}, k1 = {given.k1 or 0.0:.9g} 1/rad",
        "linear": f"K = k0 + k1 φ, k0 = {k0}, k1 = {slope}",
        "spline": _("K by the spline through {count} points").format(count=len(given.points or ())),
        "formula": f"K = {given.formula} 1/m",
    }[given.law]
    if given.symmetric:
        law += ", " + _("the same on both sides of φ = 0")
    start = _("ρ = {radius}, pressure angle {angle}").format(
        radius=units.text(cam.start.radius, digits=9), angle=units.angle(cam.start.pressure_angle)
    )
    low, high = ends_of(cam)
    return [
        (_("curvature law"), law),
        (_("start"), start),
        (_("range"), _("{first} to {last}").format(first=units.angle(low), last=units.angle(high))),
    ]


def _sizes(cam: Cam, path: RollerPath) -> tuple[Rows, dict[str, Scalar]]:
    units = Units(cam)
    radius, gamma, bent = radius_extremes(path), pressure_extremes(path), curvature_extremes(path)
    steepest, at = (
        (gamma.greatest, gamma.at_greatest)
        if gamma.greatest >= -gamma.least
        else (gamma.least, gamma.at_least)
    )
    between = _("{least} at {least_at} to {greatest} at {greatest_at}")
    rows = [
        (
            _("radius ρ"),
            between.format(
                least=units.text(radius.least),
                least_at=units.angle(radius.at_least),
                greatest=units.text(radius.greatest),
                greatest_at=units.angle(radius.at_greatest),
            ),
        ),
        (
            _("greatest pressure angle"),
            _("{angle} at {at}").format(angle=units.angle(steepest), at=units.angle(at)),
        ),
        (
            _("radius of curvature"),
            _("{least} to {greatest}").format(
                least=units.text(1.0 / bent.greatest), greatest=units.text(1.0 / bent.least)
            ),
        ),
    ]
    scalars = {
        "cam_least_radius": Scalar(radius.least, "m"),
        "cam_greatest_radius": Scalar(radius.greatest, "m"),
        "cam_greatest_pressure_angle": Scalar(abs(steepest), "rad"),
        "cam_greatest_pressure_angle_at": Scalar(at, "rad"),
        "cam_least_curvature_radius": Scalar(1.0 / bent.greatest, "m"),
        "cam_greatest_curvature_radius": Scalar(1.0 / bent.least, "m"),
    }
    return rows, scalars


def _stall(cam: Cam, path: RollerPath) -> tuple[dict[str, Scalar], tuple[str, str], tuple[str, ...]]:
    """Where the follower stalls: its number, its row, and the sentence if that lies in the range."""
    units = Units(cam)
    if path.stall is not None:
        sign = "±" if cam.curvature.symmetric else ""
        places = [path.stall] if sign else stalls_of(path)
        place = _(" and ").join(f"{sign}{units.angle(one, 9)}" for one in places)
        failure = _("the follower stalls at {place}, where the pressure angle is 90 deg").format(place=place)
        failure += "; " + _("end the range before that angle")
        row = (_("stall"), _("at {place}, inside the range").format(place=place))
        return {"cam_stall": Scalar(path.stall, "rad")}, row, (failure,)
    beyond = stall_beyond(cam)
    if beyond is None:
        return {}, (_("stall"), _("none in the range")), ()
    told = _("none in the range; with this law the follower would stall at {place}")
    return (
        {"cam_stall": Scalar(beyond, "rad")},
        (_("stall"), told.format(place=units.angle(beyond, 9))),
        (),
    )


def stall_beyond(cam: Cam) -> float | None:
    """The angle [rad] at which the law would make the follower stall beyond the range; None where it does not."""
    if cam.range.stop >= FURTHER:
        return None
    longer = cam.model_copy(update={"range": cam.range.model_copy(update={"start": 0.0, "stop": FURTHER})})
    try:
        return half_path(longer).stall
    except CentrodeError:  # the law ends, or is none of a cam, before that
        return None


def _ends(cam: Cam, path: RollerPath) -> tuple[tuple[str, str], dict[str, Scalar]]:
    """What parts the ends: over a whole turn from each other, else from their mirror image."""
    units = Units(cam)
    ends = np.array([path.start, path.stop])
    gamma, radius = path.pressure_angle(ends), path.radius(ends)[0]
    if abs(path.stop - path.start - math.tau) < 1e-9:
        said = _("after a turn ρ is {gap} greater and the path has a kink of {kink}").format(
            gap=units.text(radius[1] - radius[0], digits=4), kink=units.angle(gamma[1] - gamma[0], 4)
        )
        return (_("closure"), said), {"cam_gap": Scalar(float(radius[1] - radius[0]), "m")}
    if path.stall is not None:
        return (_("closure"), _("the path ends where the follower stalls")), {}
    kink = 2.0 * float(gamma[1])
    said = _("mirrored at {place} the path has a kink of {kink}").format(
        place=units.angle(path.stop), kink=units.angle(abs(kink), 5)
    )
    return (_("closure"), said), {"cam_mirrored_kink": Scalar(abs(kink), "rad")}


def _drawn(dataset: xr.Dataset) -> tuple[tuple[str, str], dict[str, Scalar]]:
    law, drawn = dataset["law_curvature"].to_numpy(), dataset["drawn_curvature"].to_numpy()
    with np.errstate(all="ignore"):
        apart = np.abs(drawn / law - 1.0)
    if not np.isfinite(apart).any():
        return (_("curvature of the drawn curve"), _("three neighbouring places are needed")), {}
    worst = float(np.nanmax(apart))
    said = _("within {share:.2g} of the law's (circles through three of {count} places)")
    told = said.format(share=worst, count=dataset.sizes["sample"])
    return (_("curvature of the drawn curve"), told), {"cam_drawn_curvature_difference": Scalar(worst, "1")}


# The three routes to a cam's path in words, and their table.

MOST_LINES = 19
PLACES = 3
"""So many places at which formula (16) has no meaning are named."""


def routes_part(cam: Cam, asked: Asked) -> CamPart:
    """One series, series expanded anew, an integrator, beside each other."""
    found = cam_routes(cam, asked.samples, terms=asked.terms)
    shown = cam_routes(cam, at=cam.study.instants, terms=asked.terms) if cam.study.instants else thin(found)
    return CamPart(
        _("Three routes to the path"),
        _rows(cam, found),
        _scalars(found),
        {"cam-routes": found},
        (_table(cam, shown),),
    )


def thin(found: xr.Dataset) -> xr.Dataset:
    """A few of many samples, both ends among them."""
    count = found.sizes["sample"]
    if count <= MOST_LINES:
        return found
    return found.isel(sample=np.round(np.linspace(0, count - 1, MOST_LINES)).astype(int))


def _rows(cam: Cam, found: xr.Dataset) -> Rows:
    told = found.attrs
    steps = int(told["steps"])
    expanded = ngettext(
        "{count} series of degree {order} expanded anew, tolerance {tolerance:g}",
        "{count} series of degree {order} expanded anew, tolerance {tolerance:g}",
        steps,
    ).format(count=steps, order=int(told["order"]), tolerance=told["tolerance"])
    integrated = _("Runge-Kutta of eighth order along the arc: {share:.1e} of ρ from (b) at most").format(
        share=told["worst_difference"]
    )
    return [
        (_("(a) one series"), _series(cam, found)),
        *_lost(found),
        ("", _reach(cam, found)),
        ("", _valid(cam, found)),
        (_("(b) by steps"), expanded),
        (_("(c) integrated"), integrated),
        *_stalls(cam, found),
    ]


def _series(cam: Cam, found: xr.Dataset) -> str:
    """The cut series and its greatest error."""
    terms, worst = int(found.attrs["terms"]), _greatest(found["series_error"])
    if math.isnan(worst):
        return _("power series about φ = 0, cut after a_{terms}: no sample to compare it at").format(
            terms=terms
        )
    return _("power series about φ = 0, cut after a_{terms}: greatest error of ρ {error}").format(
        terms=terms, error=Units(cam).text(worst, digits=3)
    )


def _lost(found: xr.Dataset) -> Rows:
    """Samples of the path at which the cut series gives none: its sine is no sine there."""
    radii = found["path_radius"].to_numpy()
    sine = np.abs(found["pressure_sine"].to_numpy()[0])
    lost = int(np.count_nonzero((sine > 1.0) & np.isnan(radii[0]) & np.isfinite(radii[1])))
    if not lost:
        return []
    said = _("it gives no path at {count} of {of} samples: the sine η is beyond 1 there")
    return [("", said.format(count=lost, of=found.sizes["sample"]))]


def _reach(cam: Cam, found: xr.Dataset) -> str:
    """How far the series converges, and how that is known."""
    units, told = Units(cam), found.attrs
    radius, estimate = told["radius_of_convergence"], told["radius_by_coefficients"]
    if math.isnan(radius):
        return _("how far it converges is not known: its coefficients leave the range of numbers")
    if math.isinf(radius):
        return _("it ends by itself: its coefficients vanish, it converges everywhere")
    x, y = told["singularity"]
    if not math.isfinite(x):
        said = _(
            "it converges up to about {radius} (estimated from its coefficients; no singularity was found)"
        )
        return said.format(radius=units.angle(radius, 4))
    place = units.angle(x)
    if y > 1e-12:
        place = f"{math.degrees(x):.6g} deg ± i·{math.degrees(y):.6g} deg"
    said = _("it converges up to {radius}: cos γ = 0 at φ = {place}; its coefficients alone tell {estimate}")
    return said.format(radius=units.angle(radius, 7), place=place, estimate=units.angle(estimate, 4))


def _valid(cam: Cam, found: xr.Dataset) -> str:
    """Where formulas (15) and (16) part, and the first break of the law."""
    units, told = Units(cam), found.attrs
    phi = np.abs(found["carrier_angle"].to_numpy())
    low, high = told["series_from"], told["series_to"]
    if phi.max() > max(-low, high) * (1 + 1e-12):
        said = _("the law has a break: the series is that of the path from {low} to {high} only")
        return said.format(low=units.angle(low), high=units.angle(high))
    parting = found["parting"].to_numpy()
    if not np.isfinite(parting).any():
        return _("formula (16) says nothing where the curvature is constant")
    parts = _("formulas (15) and (16) part by up to {parting}").format(
        parting=units.text(_greatest(found["parting"]), digits=3)
    )
    reached = np.isfinite(found["path_radius"].to_numpy()[0])
    flat = found["carrier_angle"].to_numpy()[np.isnan(parting) & reached]
    if not len(flat):
        return parts
    places = ", ".join([units.angle(at) for at in flat[:PLACES]] + ["..."] * (len(flat) > PLACES))
    none = _("where K′ = 0 the comparison has no meaning: φ = {places}").format(places=places)
    return f"{parts}; {none}"


def _stalls(cam: Cam, found: xr.Dataset) -> Rows:
    told = found.attrs
    if not math.isfinite(told["stall"]):
        return []
    apart = abs(told["stall"] - told["stall_integrated"])
    return [(_("stall by two routes"), _("(b) and (c) find it {apart:.1e} rad apart").format(apart=apart))]


def _scalars(found: xr.Dataset) -> dict[str, Scalar]:
    told = found.attrs
    scalars = {
        "cam_series_terms": Scalar(int(told["terms"]), "1"),
        "cam_series_greatest_error": Scalar(_greatest(found["series_error"]), "m"),
        "cam_routes_difference": Scalar(told["worst_difference"], "1"),
    }
    if math.isfinite(told["radius_of_convergence"]):
        scalars["cam_radius_of_convergence"] = Scalar(told["radius_of_convergence"], "rad")
        scalars["cam_radius_of_convergence_by_coefficients"] = Scalar(told["radius_by_coefficients"], "rad")
    return {name: one for name, one in scalars.items() if math.isfinite(one.value)}


def _table(cam: Cam, shown: xr.Dataset) -> CamTable:
    units = Units(cam)
    factor, unit = units.shown("m")
    turn, angle = units.shown("rad")
    radius, sine = shown["path_radius"].to_numpy(), shown["pressure_sine"].to_numpy()
    slope = shown["pressure_sine_slope"].to_numpy()
    header = (
        f"φ, {angle}",
        f"(a) ρ, {unit}",
        f"(b) ρ, {unit}",
        "(b) η",
        "(b) η′",
        _("(a) − (b)"),
        _("foretold"),
        "(16) − (15)",
        "(c) − (b)",
    )
    lines = []
    for k, phi in enumerate(shown["carrier_angle"].to_numpy()):
        small = [
            float(shown[name].to_numpy()[k]) * factor
            for name in ("series_error", "foretold_error", "parting", "routes_difference")
        ]
        lines.append(
            (
                f"{phi * turn:.6g}",
                _number(radius[0, k] * factor, ".3f"),
                _number(radius[1, k] * factor, ".3f"),
                _number(sine[1, k], ".6f"),
                _number(slope[1, k], ".6f"),
                *(_number(one, ".1e") if one else "0" for one in small),
            )
        )
    heading = _("Differences in {unit}; foretold: by the next four terms of the series").format(unit=unit)
    return CamTable(heading, header, lines)


def _number(value: float, form: str) -> str:
    """A number, a dash where there is none; no minus before nothing."""
    if not math.isfinite(value):
        return "–"
    text = format(value, form)
    return text.removeprefix("-") if float(text) == 0 else text


def _greatest(values: xr.DataArray) -> float:
    sizes = np.abs(values.to_numpy())
    return float(np.nanmax(sizes)) if np.isfinite(sizes).any() else math.nan
