"""The words of a page, in the language that is spoken now; holes between braces are filled on the page."""

from __future__ import annotations

from centrode.errors import STATUSES_OF_MOTION
from centrode.locale import _
from centrode.quantities import status_word
from centrode.report.mechanism_page.handles import joint_words


def words_of_page() -> dict[str, object]:
    """Name of a sentence on the page -> the sentence."""
    return {
        **joint_words(),
        "play": _("Play"),
        "pause": _("Pause"),
        "picture": _("Mechanism in motion; drag a link, or use the arrow keys"),
        "quantity": _("Quantity of the curve"),
        "remove_curve": _("Remove the curve"),
        "curve": _("{what}, from {least} to {most}"),
        "numbers": _("Numbers at the cursor"),
        "status": _("status"),
        "statuses": [status_word(status) for status in STATUSES_OF_MOTION],
        "outside": _("{name} must lie between {least} and {most}"),
        "impossible": _("These dimensions are not possible: a length is zero or less."),
        "at_one": _("At {from}: {status}."),
        "between": _("From {from} to {to}: {status}."),
        "limits_at": _("Limits: {places}."),
        "misfit_status": _("{status}, closure residual up to {worst}, above its bound of {bound}"),
        "misfit": _(
            "In red: a constraint that repeats others does not fit these dimensions. "
            "This command names it, and how far it is off:"
        ),
        "cam_arm": _("The cam is not drawn: it is made for an arm of {length}, and the arm is {arm} long."),
        "all_reached": _("The mechanism reaches every position."),
        "change_points": _(
            "At change points ({places}) the signs of groups change, and derivatives near them lose digits. "
            "This command computes the motion through them:"
        ),
        "copy_command": _("Copy the command"),
        "command_copied": _("The command is copied."),
        "link_copied": _("The link is copied: it keeps the dimensions, the position and the view."),
        "table_copied": _("The table is copied as CSV."),
        "taken": _("The dimensions, the position and the view of the link are shown."),
        "damaged": _("The link is damaged and changes nothing. Copy the whole link again."),
        "foreign": _("The link belongs to another mechanism and changes nothing."),
    }
