"""Sentences on what is driven, and how."""

from __future__ import annotations

from centrode.locale import _, mark
from centrode.model.mechanism import FRAME, Drive, Mechanism
from centrode.quantities import display_unit, typeset_unit
from centrode.study.words.lists import called
from centrode.study.words.roles import Roles

# Translators: {link} and {base} are names of links, {pivot} and {point} of points; names do not change.
DRIVEN = {
    ("crank", True): mark("Crank {link} is driven: it turns about {pivot} at a constant {speed}."),
    ("crank", False): mark("Crank {link} is driven: it turns about {pivot} by a given law."),
    ("link", True): mark("Link {link} is driven: it turns about {pivot} at a constant {speed}."),
    ("link", False): mark("Link {link} is driven: it turns about {pivot} by a given law."),
    ("free", True): mark("Link {link} is driven: its angle changes at a constant {speed}."),
    ("free", False): mark("Link {link} is driven: its angle follows a given law."),
    ("relative", True): mark("Link {link} is driven against link {base} at a constant {speed}."),
    ("relative", False): mark("Link {link} is driven against link {base} by a given law."),
    ("slider", True): mark("The slider in {point} is driven along its guide at a constant {speed}."),
    ("slider", False): mark("The slider in {point} is driven along its guide by a given law."),
    ("guided", True): mark("Link {link} is driven along its guide at a constant {speed}."),
    ("guided", False): mark("Link {link} is driven along its guide by a given law."),
    ("cylinder", True): mark("Cylinder {name} is driven: its length changes at a constant {speed}."),
    ("cylinder", False): mark("Cylinder {name} is driven: its length follows a given law."),
}

BY_CAM = {
    "link": mark("Link {link} is driven by a cam, which turns at a constant {speed}."),
    "slider": mark("The slider in {point} is driven by a cam, which turns at a constant {speed}."),
    "guided": mark("Link {link} is driven along its guide by a cam, which turns at a constant {speed}."),
}


def sentence_on_drive(drive: Drive, roles: Roles) -> str:
    """What a drive drives, at a constant speed or by a law."""
    mechanism = roles.mechanism
    if drive.turning is not None:
        return _sentence_on_cam(drive, mechanism)
    constant = drive.speed is not None
    unit = mechanism.motion_parameter.drive(drive.id).speed_unit
    speed = "" if drive.speed is None else _speed(mechanism, abs(drive.speed), unit)
    if drive.kind == "distance":
        return _(DRIVEN["cylinder", constant]).format(name=drive.id, speed=speed)
    if drive.guide is not None:
        guide = mechanism.guide(drive.guide)
        kind = "slider" if guide.link is None else "guided"
        return _(DRIVEN[kind, constant]).format(point=guide.point, link=called(guide.link or ""), speed=speed)
    link = drive.link or ""
    pivot = roles.pivot(link)
    if drive.relative_to != FRAME:
        kind = "relative"
    elif pivot is None:
        kind = "free"
    else:
        kind = "crank" if roles.turns_fully(link) and not roles.is_wheel(link) else "link"
    return _(DRIVEN[kind, constant]).format(
        link=called(link), pivot=pivot, base=called(drive.relative_to), speed=speed
    )


def _sentence_on_cam(drive: Drive, mechanism: Mechanism) -> str:
    """What a cam drives, and how fast it turns."""
    speed = _speed(mechanism, drive.turning or 0.0, "rad/s")
    if drive.guide is None:
        return _(BY_CAM["link"]).format(link=called(drive.link or ""), speed=speed)
    guide = mechanism.guide(drive.guide)
    kind = "slider" if guide.link is None else "guided"
    return _(BY_CAM[kind]).format(point=guide.point, link=called(guide.link or ""), speed=speed)


def _speed(mechanism: Mechanism, speed: float, unit: str) -> str:
    display = mechanism.display
    factor, shown = display_unit(unit, str(display.length), str(display.angle))
    return f"{speed * factor:.4g} {typeset_unit(shown)}"
