"""What a tree gives beside what was recorded."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from tools.snapshots.artefacts import TOLERANCE, Artefact, Digest, differences

BITS, NUMBERS, DIFFERS = "equal bits", "equal to 1e-12", "differs"


@dataclass(frozen=True)
class Verdict:
    """How an artefact stands to its record.

    Attributes
    ----------
    name : of the artefact
    kind : one of `BITS`, `NUMBERS`, `DIFFERS`
    what : sentences that say what differs
    """

    name: str
    kind: str
    what: tuple[str, ...] = ()

    def __str__(self) -> str:
        return f"{self.kind:15s} {self.name}" + (f": {'; '.join(self.what)}" if self.what else "")


def compare(
    recorded: Mapping[str, Digest],
    given: Mapping[str, Digest],
    labels: Mapping[str, list[str]],
    tolerance: float = TOLERANCE,
) -> list[Verdict]:
    """A verdict for each artefact that was recorded or is given; `labels` name the series of those given."""
    found = []
    for name in dict.fromkeys([*recorded, *given]):
        if name not in given:
            found.append(Verdict(name, DIFFERS, ("it was recorded and is missing",)))
        elif name not in recorded:
            found.append(Verdict(name, DIFFERS, ("it is new",)))
        elif recorded[name].bits == given[name].bits:
            found.append(Verdict(name, BITS))
        else:
            what = tuple(differences(recorded[name], labels[name], given[name], tolerance))
            found.append(Verdict(name, DIFFERS if what else NUMBERS, what))
    return found


def digests_of(artefacts: Mapping[str, Artefact]) -> tuple[dict[str, Digest], dict[str, list[str]]]:
    """Digests of artefacts, and the labels of their series."""
    digests = {name: artefact.digest() for name, artefact in artefacts.items()}
    labels = {name: [label for label, _sketch in artefact.series] for name, artefact in artefacts.items()}
    return digests, labels
