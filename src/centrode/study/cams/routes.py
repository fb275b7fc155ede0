"""The three routes to a cam's path in words, and their table."""

from __future__ import annotations

import math

import numpy as np
import xarray as xr

from centrode.cams.cam import cam_routes
from centrode.locale import _, ngettext
from centrode.model.cam import Cam
from centrode.sheets.sheet import Scalar
from centrode.study.cams.said import Asked, CamPart, Rows, Table, Units

MOST_LINES = 19
PLACES = 3
"""So many places at which formula (16) has no meaning are named."""


def routes_part(cam: Cam, asked: Asked) -> CamPart:
    """One series, series expanded anew, an integrator, beside each other."""
    found = cam_routes(cam, asked.samples, terms=asked.terms)
    shown = (
        cam_routes(cam, at=cam.study.instants, terms=asked.terms) if cam.study.instants else thinned(found)
    )
    return CamPart(
        _("Three routes to the path"),
        _rows(cam, found),
        _scalars(found),
        {"cam-routes": found},
        (_table(cam, shown),),
    )


def thinned(found: xr.Dataset) -> xr.Dataset:
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


def _table(cam: Cam, shown: xr.Dataset) -> Table:
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
    return Table(heading, header, lines)


def _number(value: float, form: str) -> str:
    """A number, a dash where there is none; no minus before nothing."""
    if not math.isfinite(value):
        return "–"
    text = format(value, form)
    return text.removeprefix("-") if float(text) == 0 else text


def _greatest(values: xr.DataArray) -> float:
    sizes = np.abs(values.to_numpy())
    return float(np.nanmax(sizes)) if np.isfinite(sizes).any() else math.nan
