"""Teeth as the envelope of a rack, with fifty digits and without a formula of the package."""

from __future__ import annotations

from mpmath import mp, mpf

mp.dps = 50


def rack_corner(alpha: mpf, addendum: mpf, clearance: mpf, fillet: mpf, shift: mpf) -> tuple[mpf, mpf]:
    """Centre of the rounded edge of the rack's tooth (module 1): from the tooth's middle, below the pitch line."""
    tip = addendum + clearance
    across = mp.pi / 4 - tip * mp.tan(alpha) - fillet * mp.tan((mp.pi / 2 - alpha) / 2)
    return across, tip - shift - fillet


def gap_wall(place: tuple[mpf, mpf], normal: tuple[mpf, mpf], teeth: int) -> tuple[mpf, mpf]:
    """Where a place of the rack's tooth touches the wheel of module 1, in the axes of the gap's middle.

    The rack lies above the wheel's centre, its pitch line at the height z/2; `place` is given for its middle position.
    It has rolled as far as brings the normal through the pitch point.
    """
    radius = mpf(teeth) / 2
    x, y = place
    down = radius - y
    rolled = normal[0] / -normal[1] * down - x
    turned = rolled / radius
    at_x, at_y = x + rolled, y
    return (
        at_x * mp.cos(turned) - at_y * mp.sin(turned),
        at_x * mp.sin(turned) + at_y * mp.cos(turned),
    )


def tooth_side(wall: tuple[mpf, mpf], teeth: int) -> tuple[mpf, mpf]:
    """A place of the gap's right wall as one of the right side of a tooth whose middle is the y axis."""
    half = mp.pi / teeth
    x, y = -wall[0], wall[1]
    return x * mp.cos(half) + y * mp.sin(half), y * mp.cos(half) - x * mp.sin(half)


def fillet_place(normal: float, teeth: int, shift: float, fillet: float) -> tuple[mpf, mpf]:
    """A place of the fillet by the angle of its normal with the pitch line, for the rack of 20 degrees."""
    alpha, angle, radius = mp.pi / 9, mpf(normal), mpf(fillet)
    across, below = rack_corner(alpha, mpf(1), mpf("0.25"), radius, mpf(shift))
    direction = mp.cos(angle), -mp.sin(angle)
    place = across + radius * direction[0], mpf(teeth) / 2 - below + radius * direction[1]
    return tooth_side(gap_wall(place, direction, teeth), teeth)


def flank_place(height: mpf, teeth: int, shift: float) -> tuple[mpf, mpf]:
    """A place of the flank, made by the place of the rack's straight flank so far above its middle line."""
    alpha = mp.pi / 9
    # The rack's middle line is `shift` above the pitch line; its tooth points down and grows thinner there.
    x = mp.pi / 4 + height * mp.tan(alpha)
    place = x, mpf(teeth) / 2 + mpf(shift) + height
    return tooth_side(gap_wall(place, (mp.cos(alpha), -mp.sin(alpha)), teeth), teeth)
