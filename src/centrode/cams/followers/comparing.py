"""Laws of motion beside each other, for one rise: peaks, and the derivatives over the rise."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.jet_functions import JetFunctions
from centrode.algebra.jets import Jet
from centrode.cams.followers.joints import ORDER
from centrode.cams.followers.stretches import derivative, extremes_of, greatest_size, power, stretches
from centrode.errors import InputError
from centrode.kinematics.dataset import labels_of, named
from centrode.laws import CURVES, Segment, SegmentedLaw
from centrode.locale import _, mark
from centrode.model.cams.files import AnyCam, with_follower
from centrode.model.problems import nearest, shown
from centrode.version import __version__

Array = npt.NDArray[np.float64]
JETS = JetFunctions(ARRAYS)
ORDERS = (1, 2, 3)
SAMPLES = 361
ITS_OWN = mark("its own")
"""Name of the description's own law beside the others, where it is none of them."""
NOTHING = 1e-9
"""A derivative that is a smaller share of rise over angle to its order is one of rounding."""


@dataclass(frozen=True)
class Peaks:
    """Coefficients of a rise h over an angle beta, none of which depends on h and beta.

    Attributes
    ----------
    coefficients : three floats
        Greatest sizes of s' beta/h, s'' beta^2/h, s''' beta^3/h, between the ends.
    torque : float
        Greatest size of s' s'' beta^3/h^2: what a mass asks of the camshaft.
    first_jump : int or None
        The lowest derivative that jumps inside, or at an end where a dwell follows; None if up to the fourth none does.
    """

    coefficients: tuple[float, float, float]
    torque: float
    first_jump: int | None


def peaks_of(law: SegmentedLaw, number: int = 0) -> Peaks:
    """Peaks of a segment of a law, counted from 0; of a dwell all are 0."""
    parts, segment = stretches(law, number), law.segments[number]
    (start, _end), (_start, end) = parts[0].ends, parts[-1].ends
    before = parts[0].derivatives(np.array([start]), ORDER)[:, 0]
    after = parts[-1].derivatives(np.array([end]), ORDER)[:, 0]
    rise, angle = float(after[0] - before[0]), end - start
    if segment.to is None or rise == 0:
        return Peaks((0.0, 0.0, 0.0), 0.0, segment.inner_jump)
    first, second, third = (
        abs(greatest_size(extremes_of(law, k + 1, derivative(k), number))[0] * angle**k / rise)
        for k in ORDERS
    )
    torque = abs(greatest_size(extremes_of(law, 3, power, number))[0]) * angle**3 / rise**2
    sizes = np.abs(np.stack([before, after])) * angle ** np.arange(ORDER + 1) / abs(rise)
    jumps = [order for order in range(1, ORDER + 1) if (sizes[:, order] > NOTHING).any()]
    jumps += [] if segment.inner_jump is None else [segment.inner_jump]
    least = min(jumps, default=ORDER + 1)
    return Peaks((first, second, third), torque, least if least <= ORDER else None)


def compare_laws(
    rise: float = 1.0,
    angle: float = 1.0,
    speed: float | None = None,
    curves: Sequence[str] = tuple(CURVES),
    own: Segment | None = None,
    samples: int = SAMPLES,
) -> xr.Dataset:
    """Laws of motion beside each other, for one rise.

    Parameters
    ----------
    rise : float [m or rad], not 0
    angle : float [rad], positive
        Of the cam meanwhile.
    speed : float [rad/s]
        Of the cam; with it the peaks are also told in time.
    curves : names of curves
    own : Segment
        A further law, from 0 to `rise` over `angle`.
    samples : int
        Of each curve.

    Returns
    -------
    Dataset
        Along `law`: `peak_coefficient` (order 1 to 3: velocity, acceleration, jerk; sizes, between the ends),
        `torque_coefficient`, `first_jump` (order of the lowest derivative that jumps, against dwells at the ends; 0
        if up to the fourth none does); along `sample` over `share` of the angle: `rise_share`, with derivatives along
        `derivative` (0 to 3), in shares of the rise. Attributes: rise, angle, speed.

    Raises
    ------
    InputError
        An unknown curve, or numbers that make no rise.
    """
    names = [*curves]
    for name in names:
        if name not in CURVES:
            raise InputError(
                "curves", _("there is no curve {name}").format(name=shown(name)), nearest(name, CURVES)
            )
    if not (math.isfinite(rise) and rise and math.isfinite(angle) and angle > 0):
        raise InputError("", _("a rise needs a height that is not 0 and a positive angle"), _("correct them"))
    laws = {name: SegmentedLaw((Segment(1.0, 1.0, name),)) for name in names}
    if own is not None:
        laws[ITS_OWN] = SegmentedLaw((own,))
    return _labelled(laws, rise, angle, speed, samples)


def _labelled(
    laws: Mapping[str, SegmentedLaw], rise: float, angle: float, speed: float | None, samples: int
) -> xr.Dataset:
    if not laws:
        raise InputError("curves", _("no law is given"), _("name one or more"))
    share = np.linspace(0.0, 1.0, samples)
    peaks = [peaks_of(law) for law in laws.values()]
    curves = [_over(law, share, rise if name == ITS_OWN else 1.0) for name, law in laws.items()]
    data = {
        "peak_coefficient": named(
            "peak_coefficient", ("law", "derivative"), [[np.nan, *one.coefficients] for one in peaks]
        ),
        "torque_coefficient": named("torque_coefficient", ("law",), [one.torque for one in peaks]),
        "first_jump": named("first_jump", ("law",), [one.first_jump or 0 for one in peaks]),
        "rise_share": named("rise_share", ("law", "derivative", "sample"), np.stack(curves)),
    }
    coordinates = {
        "law": labels_of(tuple(laws)),
        "derivative": [0, *ORDERS],
        "share": named("share", ("sample",), share),
    }
    facts = {"rise": rise, "angle": angle, "version": __version__}
    return xr.Dataset(data, coords=coordinates, attrs=facts | ({} if speed is None else {"speed": speed}))


def _over(law: SegmentedLaw, share: Array, rise: float) -> Array:
    """Shares of the rise with three derivatives by the share of the angle."""
    angle = law.period
    jet = law.jet(JETS, Jet.variable(share * angle, ORDERS[-1]))
    found = [np.broadcast_to(jet.derivative(k), share.shape) * angle**k / rise for k in (0, *ORDERS)]
    return np.stack(found)


def first_rise(cam: AnyCam) -> int:
    """The first segment of a cam that moves its follower, counted from 0."""
    before = 0.0
    for number, segment in enumerate(with_follower(cam).segments):
        if segment.to is not None and segment.to != before:
            return number
        before = before if segment.to is None else segment.to
    what = _("no segment ends at another lift than it begins at: there is no rise to compare laws for")
    raise InputError("[[segments]]", what, _("leave --laws out, or use ct.compare_laws"))


def cam_laws(cam: AnyCam, samples: int = SAMPLES) -> xr.Dataset:
    """Laws of motion beside each other for the first rise of a cam, with its own if it is none of them.

    Parameters
    ----------
    cam : PlateCam
    samples : int
        Of each curve.

    Raises
    ------
    InputError
        A cam that is given by a curvature law.
    """
    plate = with_follower(cam)
    segment = plate.segments[first_rise(plate)]
    own = None if segment.curve in CURVES else segment.law
    found = compare_laws(segment.to or 0.0, segment.angle, plate.body.speed, own=own, samples=samples)
    return found.assign_attrs(title=plate.title, segment=first_rise(plate), curve=segment.curve)
