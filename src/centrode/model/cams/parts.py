"""Parts of a cam's description: curvature law, start, range, roller, return arc, mover, contact, choice, study."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field, PlainValidator, ValidationInfo, field_validator

from centrode.locale import _
from centrode.model import limits
from centrode.model.asked import read_samples
from centrode.model.cams.values import (
    Curved,
    Flag,
    Size,
    Steepness,
    Stress,
    read_constants,
    read_formula,
    read_parameters,
    read_points,
    read_poisson,
    whole,
)
from centrode.model.entries import choice, listed
from centrode.model.frozen import FrozenMap
from centrode.model.part import Part, missing_key
from centrode.model.problems import Problem, shown
from centrode.model.values import Angle, not_negative, positive, quantity, si

LAWS = ("constant", "exponential", "linear", "spline", "formula")
_NEEDED: dict[str, tuple[str, ...]] = {
    "constant": ("k0",),
    "exponential": ("k0", "k1"),
    "linear": ("k0", "k1"),
    "spline": ("points",),
    "formula": ("formula",),
}
MOST_TERMS = 2000
"""Terms of a power series; the recursions cost their square."""

LEAST_LEGS, MOST_LEGS = 3, 24
MINIMISED = ("size", "stress", "pressure_angle")
MEASURED = (*MINIMISED, "lift", "gap")


class Curvature(Part):
    """The law K(phi) of the curvature of the path of the roller's centre.

    Attributes
    ----------
    law : one of `LAWS`
    k0 : float [1/m]
        The curvature at phi = 0 of a constant, exponential or linear law.
    k1 : float
        K = k0 exp(k1 phi) with k1 [1/rad], or K = k0 + k1 phi with k1 [1/m/rad].
    points : rows of (phi [rad], K [1/m])
        What a spline passes through.
    constants : mapping of letter to number
        Letters of the formula besides phi, in SI.
    formula : str
        K [1/m] as a text formula of phi [rad].
    symmetric : bool
        Whether the law holds for phi >= 0 only, and K(-phi) = K(phi).
    """

    law: Annotated[Literal["constant", "exponential", "linear", "spline", "formula"], choice(*LAWS)]
    k0: Curved | None = None
    k1: float | None = None
    points: Annotated[tuple[tuple[float, float], ...], PlainValidator(read_points)] | None = None
    constants: Annotated[FrozenMap[str, float], PlainValidator(read_constants)] = FrozenMap({})
    formula: str | None = None
    symmetric: Flag = False

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        problems = super().key_problems(given)
        law = given.get("law")
        if law not in LAWS:
            return problems
        for key in ("k0", "k1", "points", "formula"):
            has = given.get(key) is not None
            if key in _NEEDED[law] and not has:
                problems.append(missing_key(key))
            elif has and key not in _NEEDED[law]:
                problems.append(_foreign(law, key))
        if law != "formula" and given.get("constants"):
            problems.append(_foreign(law, "constants"))
        return problems

    @field_validator("formula", mode="plain")
    @classmethod
    def _text(cls, value: object, info: ValidationInfo) -> str | None:
        return None if value is None else read_formula(value, info.data.get("constants", ()))

    @field_validator("k1", mode="plain")
    @classmethod
    def _rate(cls, value: object, info: ValidationInfo) -> float | None:
        if value is None:
            return None
        return si(value, "curvature slope" if info.data.get("law") == "linear" else "per angle")


def _foreign(law: str, key: str) -> Problem:
    what = _("a law of kind {law} has no {key}").format(law=shown(law), key=shown(key))
    return Problem(what, _("take it out, or change the law"))


class Start(Part):
    """The path at phi = 0: `radius` [m] of the roller's centre, `pressure_angle` [rad] there."""

    radius: Size
    pressure_angle: Angle = 0.0


class Range(Part):
    """Ends of the path [rad], "from" and "to" in a file; phi = 0 lies between."""

    start: Annotated[Angle, Field(alias="from")] = 0.0
    stop: Annotated[Angle, Field(alias="to")]


class Roller(Part):
    """The follower's roller: `radius` [m]."""

    radius: Size


class Return(Part):
    """The arc that brings the roller back from the end of the working arc to its beginning.

    Attributes
    ----------
    kind : "designed" or "mirrored"
        Designed by the program, joined in value, slope and curvature; or the mirror image, with the kink it has.
    least_radius, greatest_radius : float [m]
        Bounds of rho.
    least_curvature_radius : float [m]
        Bound of the radius of curvature of the profile where it is convex.
    pressure_angle : float [rad]
        Greatest admissible one.
    convex : bool
        Whether the path has to stay convex.
    """

    kind: Annotated[Literal["designed", "mirrored"], choice("designed", "mirrored")] = "designed"
    least_radius: Size | None = None
    greatest_radius: Size | None = None
    least_curvature_radius: Size | None = None
    pressure_angle: Steepness | None = None
    convex: Flag = False


class Mover(Part):
    """A wheel that walks on legs.

    Attributes
    ----------
    legs : int
        N; each works over an angle of 2 pi/N.
    post : float [m]
        C, the length of the shoe's post: the hub stands at rho(0) + C.
    working_arc : (from, to) [rad]
        Where the law holds, the return arc goes over the rest; -pi/N to pi/N if left out.
    """

    legs: Annotated[int, whole(LEAST_LEGS, MOST_LEGS)]
    post: Annotated[float, quantity("length", not_negative)] = 0.0
    working_arc: Annotated[tuple[Angle, ...], listed(2)] | None = None


class Material(Part):
    """A material: `elasticity` (modulus) [Pa] and Poisson's ratio `poisson`."""

    elasticity: Stress
    poisson: Annotated[float, quantity("ratio", read_poisson)] = 0.3


class Contact(Part):
    """The contact of roller and cam.

    Attributes
    ----------
    force : float [N]
        P, along the follower.
    width : float [m]
        b, length of the line of contact.
    cam, roller : Material
        `roller` is of the cam's material if left out.
    admissible : float [Pa]
        Greatest contact stress.
    outer : bool
        The roller leans on the outer wall of a groove.
    """

    force: Annotated[float, quantity("force", positive)]
    width: Size
    cam: Material
    roller: Material | None = None
    admissible: Stress | None = None
    outer: Flag = False


class Choose(Part):
    """Parameters to be chosen so that bounds hold and something is least.

    Attributes
    ----------
    parameters : mapping of name to (least, greatest)
        Names of `PARAMETERS`, numbers in SI.
    minimise : one of `MINIMISED`
    stress : float [Pa], pressure_angle : float [rad], size : float [m]
        Greatest admissible ones; the stress is that of the contact if left out, the size the greatest rho.
    lift, gap : float [m]
        Least ones: of rho at the end over that at phi = 0, and of the ground between the prints of two shoes.
    trade_off : one of `MEASURED`
        Its bound is moved, to show what it costs in what is made least.
    """

    parameters: Annotated[FrozenMap[str, tuple[float, float]], PlainValidator(read_parameters)]
    minimise: Annotated[Literal["size", "stress", "pressure_angle"], choice(*MINIMISED)] = "size"
    stress: Stress | None = None
    pressure_angle: Steepness | None = None
    size: Size | None = None
    lift: Size | None = None
    gap: Size | None = None
    trade_off: Annotated[
        Literal["size", "stress", "pressure_angle", "lift", "gap"] | None, choice(*MEASURED)
    ] = None


class CamStudy(Part):
    """What is to be computed.

    Attributes
    ----------
    samples : int
        Evenly spaced over the range, both ends included.
    terms : int
        The power series is cut after a_terms.
    instants : tuple of float [rad]
        Angles of the carrier at which positions are shown.
    """

    samples: Annotated[int, PlainValidator(read_samples)] | None = None
    terms: Annotated[int, whole(2, MOST_TERMS)] = 20
    instants: Annotated[tuple[Angle, ...], listed(limits.INSTANTS)] = ()
