"""Results that do not differ are computed once in a process, however many commands, reports and variants want them."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest

import centrode as ct
from centrode.assignments import results as variant_results
from centrode.locale import chosen_language
from centrode.report import study as report_study

Computes = Callable[..., Any]


def once(compute: Computes) -> Computes:
    """A computation of a mechanism that gives what it gave for the same description, arguments and language.

    Its results are read, not written; a refusal is computed again.
    """
    known: dict[Any, Any] = {}

    @functools.wraps(compute)
    def look_up(mechanism: ct.Mechanism, *arguments: Any, **options: Any) -> Any:
        key = ct.mechanism_text(mechanism), arguments, tuple(sorted(options.items())), chosen_language()
        if key not in known:
            known[key] = compute(mechanism, *arguments, **options)
        return known[key]

    return look_up


SHARED = [
    (module, name, once(getattr(module, name)))
    for module, name in (
        (variant_results, "integrate_both"),
        (variant_results, "study"),
        (report_study, "check"),
        (report_study, "equations"),
        (report_study, "study"),
    )
]


@contextmanager
def computed_once() -> Iterator[None]:
    """Context in which studies of variants and of reports share what they compute of a mechanism.

    For tests of what stands in tables, folders and chapters; what is computed is tested where it is computed.
    """
    with pytest.MonkeyPatch.context() as patch:
        for module, name, compute in SHARED:
            patch.setattr(module, name, compute)
        yield
