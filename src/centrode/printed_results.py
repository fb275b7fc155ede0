"""Results that print as their summary, in a console as well as by `print`."""

from __future__ import annotations

import importlib

from centrode.errors import CentrodeError


class PrintsSummary:
    """A result whose text is what `centrode.summary` says about it.

    The summary is loaded when a result is printed: computing knows nothing of texts.
    """

    def __repr__(self) -> str:
        presentation = importlib.import_module("centrode.topics.presentation")
        try:
            return str(presentation.summary(self))
        except CentrodeError:  # a part of a result, or one without its description
            return super().__repr__()
