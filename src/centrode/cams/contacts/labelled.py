"""Contact stress of a described cam as a labelled result."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from centrode.cams.choosing.families import contact_of, working_arc
from centrode.cams.contacts.along import Greatest, Stressed, stress_along
from centrode.cams.contacts.line import Contact
from centrode.cams.described import path_of
from centrode.cams.labelled import status_of
from centrode.cams.path import stalls_of
from centrode.cams.sampled import angles_of
from centrode.errors import InputError
from centrode.kinematics.dataset import named
from centrode.locale import _
from centrode.model.cams.files import AnyCam, curved

Array = NDArray[np.float64]


def cam_contact(cam: AnyCam, samples: int | None = None) -> xr.Dataset:
    """Contact of roller and cam over the working arc.

    Parameters
    ----------
    cam : Cam
        With `[contact]`.
    samples : int
        Evenly spaced over the working arc, both ends included; the description's own number, else 361.

    Returns
    -------
    Dataset
        By the angle `carrier_angle`: `contact_stress`, `contact_stress_by_source`, `contact_shear`,
        `contact_depth`, `contact_half_width` and `cam_curvature_radius`, NaN where the cam is undercut or the
        follower has stalled. Its attributes hold the greatest stress by both formulas with its angle, of a symmetric
        cam the positive one; infinite where the working arc ends in a stall.

    Raises
    ------
    InputError
        No contact, a curvature that no cam has; a strip wider than the roller, for which the formulas do not hold.
    """
    cam = curved(cam)
    contact = contact_of(cam)
    if contact is None:
        what = _("the contact stress needs the force, the width and the materials")
        raise InputError("[contact]", what, _("write a table [contact]"))
    path = path_of(cam)
    low, high = working_arc(cam)
    ends = max(low, path.start), min(high, path.stop)
    phi = np.linspace(*ends, len(angles_of(cam, samples)))
    looked = (0.0, ends[1]) if cam.curvature.symmetric else ends
    found = stress_along(path, contact, phi, looked)
    stalls = [one for one in stalls_of(path) if one in looked]
    if stalls:  # cos gamma runs to zero
        endless = Greatest(math.inf, stalls[-1])
        found = replace(found, greatest=endless, greatest_by_source=endless)
    _check_strip(found, contact)
    values = {
        "contact_stress": found.strip.pressure,
        "contact_stress_by_source": found.by_source,
        "contact_shear": found.strip.shear,
        "contact_depth": found.strip.depth,
        "contact_half_width": found.strip.half_width,
        "cam_curvature_radius": found.cam_radius,
    }
    attributes: dict[str, Any] = {
        "title": cam.title,
        "greatest_stress": found.greatest.value,
        "greatest_stress_at": found.greatest.angle,
        "greatest_stress_by_source": found.greatest_by_source.value,
        "greatest_stress_by_source_at": found.greatest_by_source.angle,
        "contact_modulus": contact.modulus,
    }
    if cam.contact is not None and cam.contact.admissible is not None:
        attributes["admissible_stress"] = cam.contact.admissible
    data = {name: named(name, ("sample",), one) for name, one in values.items()}
    data["status"] = status_of(path, phi)
    coordinates = {"carrier_angle": named("carrier_angle", ("sample",), phi)}
    return xr.Dataset(data, coords=coordinates, attrs=attributes)


def _check_strip(found: Stressed, contact: Contact) -> None:
    """Raise InputError where all strips are wider than the roller: a force or modulus in other units."""
    widths = 2.0 * found.strip.half_width
    known = widths[np.isfinite(widths)]
    if known.size and float(known.min()) > 2.0 * contact.roller_radius:
        what = _("the strip of contact would be {width:.4g} mm wide, wider than the roller").format(
            width=1e3 * float(known.min())
        )
        raise InputError(
            "[contact]", what, _('check the units: a force such as "3 kN", an elasticity "206 GPa"')
        )
