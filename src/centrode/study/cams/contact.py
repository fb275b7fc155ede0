"""The contact of roller and cam in words: the greatest stress by both formulas, the strip there, what is admissible."""

from __future__ import annotations

from math import isfinite, isinf, isnan

import numpy as np
import xarray as xr

from centrode.cams.results import cam_contact
from centrode.locale import _
from centrode.model.cam import Cam
from centrode.sheets.sheet import Scalar
from centrode.study.cams.parts import Asked, CamPart, Rows, Units

MEGA = 1e-6


def contact_part(cam: Cam, asked: Asked) -> CamPart | None:
    """The contact over the working arc; nothing where the description has none."""
    if cam.contact is None:
        return None
    found = cam_contact(cam, asked.samples)
    scalars = {
        "greatest_contact_stress": Scalar(found.attrs["greatest_stress"], "Pa"),
        "greatest_contact_stress_at": Scalar(found.attrs["greatest_stress_at"], "rad"),
        "greatest_contact_stress_by_source": Scalar(found.attrs["greatest_stress_by_source"], "Pa"),
    }
    known = {name: one for name, one in scalars.items() if isfinite(one.value)}
    return CamPart(_("Contact of roller and cam"), contact_rows(cam, found), known, {"cam-contact": found})


def contact_rows(cam: Cam, contact: xr.Dataset) -> Rows:
    """The greatest contact stress by both formulas, and the strip there.

    Parameters
    ----------
    cam : Cam
    contact : Dataset
        Of `cam_contact`.
    """
    facts = contact.attrs
    if isinf(facts["greatest_stress"]):
        told = _("without bound towards {angle}, where the follower stalls")
        return [
            (_("greatest contact stress"), told.format(angle=Units(cam).angle(facts["greatest_stress_at"])))
        ]
    if isnan(facts["greatest_stress"]):
        return [(_("greatest contact stress"), _("none: the cam is undercut all along"))]
    sign = "±" if cam.curvature.symmetric and facts["greatest_stress_at"] else ""
    told = _("{stress} at {sign}{angle}").format(
        stress=_mega(facts["greatest_stress"]), sign=sign, angle=Units(cam).angle(facts["greatest_stress_at"])
    )
    source = _("{stress} by the source's formula, with 0.418").format(
        stress=_mega(facts["greatest_stress_by_source"])
    )
    at = int(np.nanargmax(contact["contact_stress"].to_numpy()))
    strip = _("{width:.4g} mm wide; greatest shear {shear} at a depth of {depth:.4g} mm").format(
        width=2e3 * float(contact["contact_half_width"][at]),
        shear=_mega(float(contact["contact_shear"][at])),
        depth=1e3 * float(contact["contact_depth"][at]),
    )
    rows = [(_("greatest contact stress"), told + _bound(facts)), ("", source), (_("strip there"), strip)]
    missing = int(np.isnan(contact["contact_stress"].to_numpy()).sum())
    if missing:
        rows.append(("", _("no contact at {n} of {of} samples: the cam is undercut there").format(
            n=missing, of=contact.sizes["sample"]
        )))  # fmt: skip
    return rows


def _bound(facts: dict[str, float]) -> str:
    admissible = facts.get("admissible_stress")
    if admissible is None:
        return ""
    if facts["greatest_stress"] <= admissible:
        return _(", admissible {stress}").format(stress=_mega(admissible))
    return _(", more than the admissible {stress}").format(stress=_mega(admissible))


def _mega(stress: float) -> str:
    return f"{MEGA * stress:.6g} MPa"
