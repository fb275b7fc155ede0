"""Operations of the workbench on the text of a description: each is written as a person would write it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from centrode.app.cam_segments import add_segment, delete_segment, set_curve
from centrode.app.deletion import delete_objects
from centrode.app.drawing_operations import add_guide, add_link, add_point
from centrode.app.drive_starts import set_starts
from centrode.app.duplication import duplicate, mirror
from centrode.app.name_changes import join_points, rename
from centrode.app.number_fields import lock, move_point, set_number
from centrode.app.patches import Operation, Patch
from centrode.app.sketch import SketchParts
from centrode.app.state_rows import ensure_references, set_row
from centrode.errors import InputError
from centrode.locale import _

OPERATIONS: Mapping[str, Callable[[Patch, Operation], None]] = {
    "add_link": add_link,
    "add_point": add_point,
    "add_guide": add_guide,
    "set_row": set_row,
    "set": set_number,
    "set_starts": set_starts,
    "delete": delete_objects,
    "duplicate": duplicate,
    "mirror": mirror,
    "move_point": move_point,
    "rename": rename,
    "lock": lock,
    "join": join_points,
    "add_segment": add_segment,
    "delete_segment": delete_segment,
    "set_curve": set_curve,
}
"""Name of an operation in a message -> what it does to the text."""
NEEDS_MECHANISM = ("set", "rename", "move_point", "mirror", "join")
"""Operations that are refused where they spoil a mechanism: a drawing may be unfinished on the way, a number that does
not fit is a mistake."""


def apply_operations(text: str, folder: Path, operations: Sequence[Operation]) -> Patch:
    """A text after operations, one after the other; InputError where one is refused."""
    patch = Patch(text, folder)
    for operation in operations:
        apply_operation(patch, operation)
    return patch


def apply_operation(patch: Patch, operation: Operation) -> None:
    """Change the text by an operation; InputError, and nothing changes, where it is refused."""
    name = operation.get("do", operation.get("op"))
    change = OPERATIONS.get(name) if isinstance(name, str) else None
    if change is None:
        raise InputError("", _("the server does not know this operation"))
    before, text = patch.document, patch.text
    if before.problems and not before.tables and text.strip():
        first = before.problems[0]
        what = _("line {line} cannot be read: {message}").format(line=first.line, message=first.message)
        raise InputError("", what, _("correct it in the text first"))
    try:
        change(patch, operation)
        ensure_references(patch)
        if before.prepared is not None and patch.document.prepared is None:
            patch.keep_places(SketchParts(before))
        after = patch.document
        broken = before.mechanism is not None and after.mechanism is None and after.tables.get("links")
        if broken and name in NEEDS_MECHANISM:
            first = after.problems[0]
            raise InputError(first.path, first.message, first.repair)
    except (KeyError, IndexError, TypeError, ValueError, AttributeError) as fault:
        patch.text = text
        what = _("this part of the text is written in a way that cannot be changed here")
        raise InputError("", what, _("change it in the text")) from fault
    except InputError:
        patch.text = text
        raise
