"""What stands below the title of a frame: the values of the drives or the time, the cam's angle."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.followers.geometry import Oscillating
from centrode.errors import Status
from centrode.locale import decimal_mark
from centrode.present.animations.layers import Array
from centrode.present.shown import shown_as
from centrode.quantities import QUANTITIES, status_word, typeset_unit

if TYPE_CHECKING:
    from centrode.cams.followers.geometry import FollowerCam
    from centrode.model.settings import Display
    from centrode.study.moving.films import Film

DIGITS = 4


def instant_captions(film: Film) -> list[str]:
    """The caption of each frame: the value of the only drive that moves evenly, else the time, and the status.

    The status stands there where it is not in order. All have as many decimals, so that no digit jumps.
    """
    mechanism = film.mechanism
    parameter = mechanism.motion_parameter
    factor, unit = shown_as(parameter.instant.unit, mechanism.display)
    symbol, values = parameter.instant.symbol, factor * parameter.instants(film.motion)
    decimals = _decimals(values, unit)
    # plain text: mathematical text is laid out for every frame anew, at many times the cost
    texts = [f"{symbol} = {_plain(value, decimals)} {typeset_unit(unit)}" for value in values]
    for k, status in enumerate(film.motion["status"].to_numpy().tolist()):
        if status != Status.OK:
            texts[k] += f" ({status_word(status)})"
    return [texts[sample] for sample in film.order]


def turned_caption(angle: float, display: Display | None) -> str:
    """The angle that the carrier of a cam's rollers has turned by."""
    factor, unit = shown_as("rad", display)
    quantity = QUANTITIES["carrier_angle"]
    return f"{quantity.symbol} = {_plain(factor * angle, 1 if unit == 'deg' else 3)} {typeset_unit(unit)}"


def follower_captions(body: FollowerCam, angles: Array, display: Display | None) -> list[str]:
    """The angle of the cam and the lift of its follower, frame by frame, with as many decimals in all of them."""
    factor, unit = shown_as("rad", display)
    lift_unit = "rad" if isinstance(body.guide, Oscillating) else "m"
    lift_factor, lift_shown = shown_as(lift_unit, display)
    lifts = lift_factor * body.motion.lift(np.mod(angles, math.tau))[0]
    decimals = _decimals(lifts, lift_shown)
    turned, lifted = QUANTITIES["cam_angle"].symbol, QUANTITIES["lift"].symbol
    return [
        f"{turned} = {_plain(factor * angle, 1 if unit == 'deg' else 3)} {typeset_unit(unit)},  "
        f"{lifted} = {_plain(lift, decimals)} {typeset_unit(lift_shown)}"
        for angle, lift in zip(angles.tolist(), lifts.tolist(), strict=True)
    ]


def _decimals(values: Array, unit: str) -> int:
    """Decimals that all values are written with, so that no digit jumps."""
    greatest = float(np.nanmax(np.abs(values), initial=0.0))
    decimals = max(0, DIGITS - 1 - int(np.floor(np.log10(greatest)))) if greatest > 0.0 else 0
    return min(decimals, 1) if unit == "deg" else min(decimals, 9)


def _plain(value: float, decimals: int) -> str:
    text = f"{value:.{decimals}f}"
    if float(text) == 0.0:
        text = text.lstrip("-")
    return text.replace("-", "−").replace(".", decimal_mark())
