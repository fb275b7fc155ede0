"""Second routes to a profile: closed forms, and the contact by the instant centre."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.followers.forces import meeting_of
from centrode.locale import _
from centrode.render.document.blocks import Check
from centrode.report.chapters.followers.parts import ROUNDED
from centrode.report.chapters.followers.textbook import Array, Textbook
from centrode.report.telling import measured

if TYPE_CHECKING:
    from centrode.cams.followers.geometry import FollowerCam
    from centrode.report.study import ReportStudy

PLACES = 721


def angles() -> Array:
    """Angles [rad] of a turn at which routes are compared."""
    return np.linspace(0.0, 2.0 * np.pi, PLACES)[:-1]


def closed_forms(study: ReportStudy, body: FollowerCam) -> Iterator[Check]:
    """Pressure angle and curvature by the formulas above against those of the envelope."""
    del study
    book, phi = Textbook(body), angles()
    rows, found = body.motion.lift(phi, 3), body.contact(phi)
    if book.has_pressure_angle:
        apart = float(np.abs(np.arctan(book.pressure(rows)) - found.pressure_angle).max())
        text = _("At 720 angles the formula of $alpha$ and the normal of the envelope agree to {share} rad.")
        yield measured(text, apart, 1.0, ROUNDED)
    with np.errstate(divide="ignore"):
        apart = float(
            np.max(
                np.abs(1.0 / book.radius(rows) - found.curvature)
                / (1.0 / body.base_radius + np.abs(found.curvature))
            )
        )
    text = _("There the formula of $R$ and the curvature of the envelope agree to {share} of the curvature.")
    # near a cusp R is what is left of much greater numbers
    worst = float(
        np.max(np.abs(found.path_curvature * found.bend), initial=1.0, where=np.isfinite(found.bend))
    )
    yield measured(text, apart, 1.0, ROUNDED * max(1.0, worst, *_lost(body, found.stretch)))


def _lost(body: FollowerCam, stretch: Array) -> tuple[float, ...]:
    """By how much digits are lost where the profile is nearly, or is, undercut."""
    size = 1.0 if np.isfinite(body.touch.roller) else body.base_radius
    return (size / float(np.abs(stretch).min()),) if np.abs(stretch).min() > 0.0 else (np.inf,)


def by_formulas(body: FollowerCam) -> Check:
    """Points by the formulas above against those of the envelope."""
    phi = angles()
    apart = np.hypot(*(Textbook(body).place(phi, body.motion.lift(phi, 3)) - body.contact(phi).place).T)
    text = _(
        "At 720 angles the formulas give the points of the envelope of the follower's places, to {share} of $r_0$."
    )
    return measured(text, float(apart.max()), body.base_radius, ROUNDED)


def by_instant_centre(body: FollowerCam) -> Check:
    """Points and normals from the instant centre of cam and follower, which no profile enters."""
    phi = angles()
    found, met = body.contact(phi), meeting_of(body, body.motion.lift(phi, 3))
    roller = body.touch.roller if np.isfinite(body.touch.roller) else 0.0
    place = met.place - roller * met.normal
    apart = float(np.hypot(*(body.in_frame(found.place, phi) - place).T).max())
    text = _(
        "The normal through the instant centre of cam and follower on the line of their axes leads to the same points,"
        " to {share} of $r_0$."
    )
    return measured(text, apart, body.base_radius, ROUNDED)


def not_undercut(body: FollowerCam) -> Check:
    """The closed forms against a profile on which no stretch runs back."""
    book, phi = Textbook(body), angles()
    rows = body.motion.lift(phi, 3)
    if book.flat:
        positive = bool(np.all(book.radius(rows) > 0.0))
        return Check(
            _("The profile is not undercut: at 720 angles the formula of $R$ stays positive."), positive
        )
    positive = bool(np.all(1.0 - book.roller * book.bending(rows) > 0.0))
    return Check(_("The profile is not undercut: at 720 angles $1 - r K$ stays positive."), positive)
