"""Notebooks: mechanisms, structures, equations and every result show themselves as drawings, tables and formulas.

IPython is told by name which class is shown by which function, so that nothing is imported before it is shown.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import lazy_loader

if TYPE_CHECKING:
    from centrode.notebook.display import (
        check_html,
        equations_markdown,
        mechanism_html,
        motion_html,
        result_html,
    )

__all__ = ["check_html", "equations_markdown", "mechanism_html", "motion_html", "register", "result_html"]

__getattr__, __dir__, _names = lazy_loader.attach(
    __name__,
    submod_attrs={
        "display": ["check_html", "equations_markdown", "mechanism_html", "motion_html", "result_html"]
    },
)

SHOWN = (
    ("text/html", "centrode.model.mechanism", "Mechanism", "mechanism_html"),
    ("text/html", "centrode.study.check", "MechanismCheck", "check_html"),
    ("text/html", "xarray.core.dataset", "Dataset", "motion_html"),
    ("text/html", "centrode.topics.presentation", "Result", "result_html"),
    ("text/markdown", "centrode.equations.derivation", "Equations", "equations_markdown"),
)
"""Kind of presentation, module and name of a class, and the function that presents it."""


def register() -> None:
    """Tell the running IPython, if there is one, how centrode's results are shown."""
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    if shell is None:
        return
    own = {(module, name) for _kind, module, name, _function in SHOWN}
    topics = importlib.import_module("centrode.topics.registry").TOPICS
    results = dict.fromkeys((topic.result.module, topic.result.name) for topic in topics)
    others = [("text/html", *result, "result_html") for result in results if result not in own]
    for kind, module, name, function in (*others, *SHOWN):
        shell.display_formatter.formatters[kind].for_type_by_name(module, name, _later(function))


def _later(function: str) -> Callable[[Any], str]:
    """A function of this room that is imported when something is shown."""

    def show(result: Any) -> str:
        return str(getattr(sys.modules[__name__], function)(result))

    return show
