"""What is said of instant centres and centrodes: rows of texts, in the chosen language."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
import xarray as xr

from centrode.analysis.instant_centres.bodies import Pair, sliders_of
from centrode.analysis.instant_centres.centres import Case, line_direction
from centrode.analysis.instant_centres.kennedy import Construction, KennedyStep
from centrode.errors import Status
from centrode.kinematics.preparation import ready
from centrode.locale import _
from centrode.model.labels import body_name
from centrode.model.mechanism import FRAME, Display, Mechanism
from centrode.quantities import display_unit, status_word
from centrode.study.wording import value_text

Rows: TypeAlias = list[tuple[str, ...]]


def centre_symbol(pair: Pair, bodies: int) -> str:
    """How a centre is called: P20 is that of bodies 2 and 0; with many bodies P12,0."""
    comma = "," if bodies > 10 else ""
    return f"P{pair[0]}{comma}{pair[1]}"


def initial_place(mechanism: Mechanism) -> float:
    """Value of the drive in the initial position, with a law or several drives the time there [rad, m or s]."""
    prepared = ready(mechanism)
    return float(prepared.kinematics.path.initial) if prepared.parameter.is_uniform else 0.0


def body_names(mechanism: Mechanism) -> tuple[str, ...]:
    """Bodies by number: the frame, links and sliders ("slider C": a point on a guide without a link of its own)."""
    return (FRAME, *mechanism.link_names, *sliders_of(mechanism))


def place_words(mechanism: Mechanism, motion: xr.Dataset, sample: int) -> str:
    """Where a sample is: values of the drives with their units, and its status where it is not ok."""
    values = motion["drive_value"].to_numpy()[sample]
    texts = []
    for drive, value in zip(mechanism.drives, values, strict=True):
        texts.append(
            f"{drive.id} {value_text(float(value), mechanism.motion_parameter.drive(drive.id).unit, mechanism.display)}"
        )
    status = int(motion["status"][sample])
    return ", ".join(texts) + ("" if status == Status.OK else f" ({status_word(status)})")


def centres_header(centres: xr.Dataset | None = None) -> tuple[str, ...]:
    """Headings of the columns of `centres_rows`; on the sphere (told by the centres) with the relative speed."""
    last = (_("case"), _("constructed from"), _("off"))
    if centres is None or "relative_speed" not in centres:
        return (_("centre"), _("bodies"), _("place"), *last)
    return (_("axis"), _("bodies"), _("end of the axis"), _("relative speed"), *last)


def centres_rows(
    mechanism: Mechanism,
    centres: xr.Dataset,
    sample: int,
    names: Sequence[str],
    construction: Construction | None = None,
) -> Rows:
    """Rows of one position: symbol, bodies, place, case, how it is constructed, and by how much both differ.

    On the sphere the place is the end of the axis, and the relative angular velocity about it stands behind it.

    Parameters
    ----------
    centres : Dataset
        Of `instant_centres`; `names` are all bodies by number.
    construction : Construction, optional
        Of the same position; the last two columns are empty without it. The difference is the relative
        velocity left at the constructed place, over the greatest velocity of the motion.
    """
    rows: Rows = []
    for column, label in enumerate(map(str, centres["pair"].values)):
        first, second = label.split(",")
        pair = names.index(first), names.index(second)
        at = centres.isel(sample=sample, pair=column)
        step = _step(construction, pair)
        rows.append(
            (
                centre_symbol(pair, len(names)),
                _("{first} against {second}").format(
                    first=body_name(mechanism, first), second=body_name(mechanism, second)
                ),
                place_text(at, mechanism.display),
                *_speed(at, mechanism.display),
                Case(int(at["centre_case"])).sentence,
                "" if step is None else step_text(step, names),
                "" if step is None or construction is None else f"{construction.mismatch[step.pair]:.1e}",
            )
        )
    return rows


def _speed(centre: xr.Dataset, display: Display) -> tuple[str, ...]:
    """Relative angular velocity, where there is one: on the sphere."""
    if "relative_speed" not in centre:
        return ()
    factor, unit = display_unit("rad/s", display.length, display.angle)
    speed = float(centre["relative_speed"])
    return ("-" if math.isnan(speed) else f"{factor * speed:.9g} {unit}",)


def steps_leading_to(construction: Construction, pairs: Sequence[tuple[str, str]]) -> list[str]:
    """The steps that some centres were found from, themselves left out: "P10 hinge O"."""
    names = construction.bodies
    numbers = [(names.index(first), names.index(second)) for first, second in pairs]
    wanted = {(max(pair), min(pair)) for pair in numbers}
    return [
        f"{centre_symbol(step.pair, len(names))} {step_text(step, names)}"
        for step in construction.needed(numbers).steps
        if step.pair not in wanted
    ]


def _step(construction: Construction | None, pair: Pair) -> KennedyStep | None:
    steps = () if construction is None else construction.steps
    return next((step for step in steps if step.pair == (max(pair), min(pair))), None)


def place_text(centre: xr.Dataset, display: Display) -> str:
    """Coordinates of a centre, or the direction in which it lies at infinity; a dash where there is none."""
    place = centre["centre"].to_numpy()
    if np.isfinite(place).all():
        return _place(place, display)
    if "centre_direction" not in centre:
        return "-"
    direction = centre["centre_direction"].to_numpy()
    if np.isfinite(direction).all():
        return _("at infinity, {angle:.6g} deg").format(angle=line_direction(direction.tolist()))
    return "-"


def step_text(step: KennedyStep, names: Sequence[str]) -> str:
    """How a centre was constructed."""

    def symbol(*pair: int) -> str:
        return centre_symbol((max(pair), min(pair)), len(names))

    first, second = step.pair
    if step.how == "kennedy":
        lines = [f"{symbol(first, by)} {symbol(second, by)}" for by in step.by]
        return " × ".join(lines)
    if step.how == "together":
        return f"{symbol(first, step.by[0])} = {symbol(second, step.by[0])}"
    return {
        "hinge": _("hinge {name}"),
        "guide": _("square to guide {name}") if step.place is None else _("pole of guide {name}"),
        "rolling": _("contact of {name}"),
        "gear": _("gear {name}"),
        "rest": _("no relative motion"),
        "field": _("velocity field"),
    }[step.how].format(name=step.name)


def centrode_rows(mechanism: Mechanism, centrodes: xr.Dataset) -> Rows:
    """Bodies, pieces, arcs rolled and what they differ by."""
    pieces = centrodes["centrode_piece"].to_numpy()
    arcs = [centrodes[name].to_numpy() for name in ("fixed_arc", "moving_arc")]
    rolled = [sum(_last(arc[pieces == piece]) for piece in np.unique(pieces[pieces >= 0])) for arc in arcs]
    slip = float(np.nanmax(np.abs(arcs[0] - arcs[1]), initial=0.0))
    link, against = (body_name(mechanism, str(centrodes.attrs[name])) for name in ("link", "against"))
    display, unit = mechanism.display, "m" if mechanism.space == "plane" else "rad"
    return [
        (_("bodies"), _("{first} against {second}").format(first=link, second=against)),
        (_("samples with a centre"), f"{int((pieces >= 0).sum())} / {pieces.size}"),
        (_("pieces"), str(int(pieces.max()) + 1)),
        (_("arc of the fixed centrode"), value_text(rolled[0], unit, display)),
        (_("arc of the moving centrode"), value_text(rolled[1], unit, display)),
        (_("greatest difference"), value_text(slip, unit, display)),
    ]


def _last(arc: np.ndarray[tuple[int], np.dtype[np.float64]]) -> float:
    return float(arc[-1]) if arc.size else 0.0


def curvature_rows(mechanism: Mechanism, curvature: xr.Dataset, sample: int) -> Rows:
    """Pole, inflection circle, Ball's point, and the radius of curvature of each point's path at one place."""
    here, display = curvature.isel(sample=sample), mechanism.display
    rows: Rows = [
        (_("place"), place_words(mechanism, curvature, sample)),
        (_("pole"), _place(here["pole"].to_numpy(), display)),
        (_("inflection pole"), _place(here["inflection_pole"].to_numpy(), display)),
        (_("diameter of the inflection circle"), _size(float(here["inflection_diameter"]), display)),
        (_("Ball's point"), _place(here["ball_point"].to_numpy(), display)),
    ]
    bends, centres = here["path_curvature"].to_numpy(), here["curvature_centre"].to_numpy()
    for name, bend, centre in zip(here["point"].values, bends, centres, strict=True):
        straight = np.isfinite(bend) and not np.isfinite(centre).all()
        radius = math.inf if straight else 1.0 / float(bend)
        rows.append((_("radius of the path of {point}").format(point=name), _size(radius, display)))
    return rows


def _size(value: float, display: Display) -> str:
    """A length, infinity, or a dash where there is none."""
    if math.isnan(value):
        return "-"
    return "∞" if math.isinf(value) else value_text(value, "m", display)


def _place(place: np.ndarray[tuple[int, ...], np.dtype[np.float64]], display: Display) -> str:
    if not np.isfinite(place).all():
        return "-"
    # a place on the sphere is a unit vector
    factor, unit = display_unit("m", display.length, display.angle) if len(place) == 2 else (1.0, "")
    size = float(np.max(np.abs(place)))
    shown = ", ".join(f"{0.0 if abs(v) < 1e-12 * size else v * factor:.9g}" for v in place)
    return f"({shown}) {unit}".rstrip()
