"""How a mechanism works, in words: what it is made of, how it moves, what comes of it."""

from __future__ import annotations

from collections.abc import Iterator

from centrode.kinematics.preparation import Ready, ready
from centrode.locale import _, ngettext
from centrode.model.mechanism import Mechanism
from centrode.study.rotation import rotation_of
from centrode.study.wording import value_text
from centrode.study.words.joints import sentences_on_joints
from centrode.study.words.motion import sentences_on_motion
from centrode.study.words.roles import Roles, roles_of


def describe(mechanism: Mechanism) -> str:
    """How a mechanism works, in the chosen language: paragraphs on its parts, on its motion, on what comes of it.

    Extents (strokes, angles of swing) are those over the description's own range, one turn of the drive if it names
    none, and are left out where the mechanism locks. Raises InputError as `check` does.
    """
    prepared = ready(mechanism)
    roles = roles_of(mechanism)
    paragraphs = (
        sentences_on_joints(mechanism),
        sentences_on_motion(prepared.structure, roles),
        _on_freedom(prepared, roles),
    )
    return "\n\n".join(" ".join(paragraph) for paragraph in paragraphs)


def _on_freedom(prepared: Ready, roles: Roles) -> Iterator[str]:
    """Mobility, repeated constraints, and whether the drive turns fully."""
    yield ngettext(
        "The mobility is {n}: one drive determines the place of every link.",
        "The mobility is {n}: {n} drives together determine the place of every link.",
        prepared.mobility,
    ).format(n=prepared.mobility)
    redundant = [constraint.label for constraint in prepared.structure.redundant]
    if redundant:
        yield _("Redundant constraints, which only have to fit: {constraints}.").format(
            constraints=", ".join(redundant)
        )
    rotation = rotation_of(prepared)
    if rotation.turns_fully:
        yield _("The drive can turn fully.")
    elif rotation.turns_fully is False and rotation.limit is not None:
        at = value_text(rotation.limit, rotation.unit, prepared.mechanism.display)
        # Translators: {cause} is a sentence without its full stop
        yield _("The drive cannot turn fully; it stops at {value}: {cause}.").format(
            value=at, cause=rotation.cause
        )
