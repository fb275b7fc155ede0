"""Names of points, links and guides: what one may look like, and when a link's name is made of two points."""

from __future__ import annotations

import re
import unicodedata

from centrode.locale import _
from centrode.model import limits
from centrode.model.problems import Problem, shown

FRAME = "frame"
"""The fixed link's name wherever a link is named."""

PLACED = "placed"

# Primes may stand in a name (B'), other quotes would have to be escaped in files, tables and drawings.
_REFUSED = set('/\\,"`´“”„«»')
_POINT = r"[^\W\d_]\d*['’′]*"
_TWO_POINTS = re.compile(rf"({_POINT})({_POINT})")


def read_name(value: object) -> str:
    """A name in composed form (NFC); a Problem if it cannot stand in a file, a table and a drawing."""
    if not isinstance(value, str):
        raise Problem(_("expected a name (text), got {value}").format(value=shown(value)))
    if len(value) > limits.NAME_LENGTH:
        what = _("a name has at most {most} characters, got {count}")
        raise Problem(what.format(most=limits.NAME_LENGTH, count=len(value)), _("shorten it"))
    name = unicodedata.normalize("NFC", value)
    repair = _("use letters, digits, primes, spaces, hyphens or underscores")
    if not name or name != name.strip():
        raise Problem(_("{name} is not a name").format(name=shown(value)), repair)
    if not name.isprintable() or name.startswith(".") or _REFUSED & set(name):
        raise Problem(_("{name} has characters a name may not have").format(name=shown(value)), repair)
    if name == PLACED:
        raise Problem(
            _('"placed" cannot be a name: it asks for a place along the chain'), _("choose another name")
        )
    return name


def read_link_name(value: object) -> str:
    """A link's name: any name but the fixed link's."""
    name = read_name(value)
    if name == FRAME:
        repair = _("choose another name, or put its points in [frame.points]")
        raise Problem(_('"frame" is the fixed link, a moving link has another name'), repair)
    return name


def two_points(name: str) -> tuple[str, str] | None:
    """Points of a link's name that is made of two: O1A -> (O1, A), AB' -> (A, B'); None for other names."""
    match = _TWO_POINTS.fullmatch(name)
    if not match or match.group(1) == match.group(2):
        return None
    return match.group(1), match.group(2)


def body_word(name: str) -> str:
    """A link by its name, the frame by its word in the reader's language."""
    return _("frame") if name == FRAME else name
