"""Spoilt drawings of three kinds: each becomes a description that reads back, or is refused in words."""

from __future__ import annotations

import random
import time
import warnings

from centrode.errors import CentrodeError
from centrode.model.files import parse_mechanism
from centrode.sketches.imported_sketch import sketch_content
from tools.campaigns.campaign import Campaign, Outcome
from tools.campaigns.imports.drawings import drawing

DRAWINGS = 100
"""Drawings of a case."""
LONGEST = 10.0
"""Seconds that one may take."""


def run(seed: int, number: int) -> Outcome:
    """A hundred drawings, the first of which is the case's subject unless another one is at fault."""
    draw = random.Random(f"{seed} {number}")
    outcome = Outcome()
    for _k in range(DRAWINGS):
        ending, content = drawing(draw)
        began = time.process_time()
        fault = judged(ending, content, outcome)
        took = time.process_time() - began
        outcome.measure(ending, "seconds", took)
        if took > LONGEST:
            fault = f"{ending}: {took:.1f} s"
        if fault:
            outcome.fault(fault)
        if fault or not outcome.subject:
            outcome.subject = f"{ending}\n{content!r}"
    return outcome


def judged(ending: str, content: bytes, outcome: Outcome) -> str:
    """What is wrong with how a drawing is read; empty where nothing is."""
    outcome.count("drawings")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            read = sketch_content(content, f"drawing{ending}", ending)
        except CentrodeError as refusal:
            outcome.count(f"{ending} refused")
            return "" if refusal.what and str(refusal) else f"{ending}: refused without words"
        except Exception as error:
            return f"{ending}: {type(error).__name__}: {error}"
    outcome.count(f"{ending} read")
    if parse_mechanism(read.text) != read.mechanism:
        return f"{ending}: the text is another mechanism"
    return ""


CAMPAIGN = Campaign(
    name="imports",
    title="Imported drawings",
    about=(
        "SVG, DXF and files of Linkage, a hundred a case, spoilt at random: numbers, names and elements replaced, cut, "
        "doubled, exchanged, bytes overwritten. Each becomes a description that reads back as the same mechanism and "
        "stands as it is drawn, or is refused in words."
    ),
    columns={"seconds": f"time of one drawing; bound {LONGEST:g}"},
    run=run,
    cases=1000,
)
