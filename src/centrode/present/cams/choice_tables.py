"""Tables of a choice: the start, the chosen design and the front; the description with the chosen parameters."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from centrode.model.cam_files import cam_text
from centrode.present.cams.choice import measure_shown, parameter_unit
from centrode.present.shown import shown_as

if TYPE_CHECKING:
    from centrode.cams.parameter_choice.search import CamChoice, CamDesign


def write_choice(found: CamChoice, folder: Path) -> None:
    """Write "cam-choice.csv" and, where the choice keeps its bounds, "chosen.toml" into a folder.

    Parameters
    ----------
    found : CamChoice
        Of `choose_cam`. The table has a row for the start, the chosen design and each design of the front, in the
        units of the display and megapascals; the description is in SI and can be computed like any other.
    """
    cam = found.cam
    names = list(found.choice.chosen.parameters)
    shown = [shown_as(parameter_unit(cam, name), cam.display) for name in names]
    measures = found.measures
    units = [measure_shown(name, cam.display) for name in measures]
    headers = [
        "design",
        *(f"{name} [{unit}]" for name, (_factor, unit) in zip(names, shown, strict=True)),
        *(f"{name} [{unit}]" for name, (_factor, unit) in zip(measures, units, strict=True)),
        "admissible",
    ]
    with (folder / "cam-choice.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(headers)
        for word, design in _designs(found):
            values = [
                design.parameters[name] * factor for name, (factor, _) in zip(names, shown, strict=True)
            ]
            values += [
                design.measures[name].value * factor
                for name, (factor, _) in zip(measures, units, strict=True)
            ]
            writer.writerow([word, *values, "no" if design.misses else "yes"])
    if found.choice.admissible:
        (folder / "chosen.toml").write_text(cam_text(cam), encoding="utf-8")


def _designs(found: CamChoice) -> Iterator[tuple[str, CamDesign]]:
    yield "start", found.choice.start
    yield "chosen", found.choice.chosen
    for design in found.front.designs if found.front is not None else ():
        yield "front", design
