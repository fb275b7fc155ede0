"""Tables of instant centres and centrodes, as CSV."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from centrode.analysis.instant_centres.centres import Case
from centrode.errors import Status
from centrode.present.shown import shown_as
from centrode.present.tables import field

if TYPE_CHECKING:
    import xarray

    from centrode.analysis.instant_centres.kennedy import Construction
    from centrode.model.mechanism import Mechanism


def write_centres_csv(
    mechanism: Mechanism,
    centres: xarray.Dataset,
    path: Path,
    constructions: Sequence[Construction | None] = (),
) -> None:
    """Write instant centres as CSV: one row a position and pair, in the units of the display.

    `constructions` tell of each position how its centres are constructed, and the relative velocity left there
    over the greatest of the motion.
    """
    factor, columns = _places(mechanism, ("centre",))
    spherical = mechanism.space == "sphere"
    turning, speed = shown_as("rad/s", mechanism.display)
    beside = [f"relative_speed [{speed}]"] if spherical else ["centre_direction_x", "centre_direction_y"]
    header = [
        *_instant_header(mechanism, centres),
        "first",
        "second",
        *columns,
        *beside,
        "case",
        "constructed",
        "mismatch",
    ]
    labels = [str(label).split(",") for label in centres["pair"].values]
    places = factor * centres["centre"].to_numpy()
    cases = centres["centre_case"].to_numpy()
    besides = (
        turning * centres["relative_speed"].to_numpy()[..., None]
        if spherical
        else centres["centre_direction"].to_numpy()
    )
    rows: list[list[float | str]] = []
    for sample, instant in enumerate(_instants(mechanism, centres)):
        made = constructions[sample] if sample < len(constructions) else None
        steps = {} if made is None else {step.pair: step for step in made.steps}
        for column, (first, second) in enumerate(labels):
            pair = ordered(made, first, second)
            known = made is not None and pair in steps
            rows.append(
                [
                    *instant,
                    first,
                    second,
                    *map(float, places[sample, column]),
                    *map(float, besides[sample, column]),
                    Case(int(cases[sample, column])).word,
                    steps[pair].how if known else "",
                    made.mismatch[pair] if made is not None and known else "",
                ]
            )
    _write(path, header, rows)


def ordered(made: Construction | None, first: str, second: str) -> tuple[int, int]:
    """Numbers of a pair in a construction, the later body first."""
    if made is None:
        return -1, -1
    numbers = made.bodies.index(first), made.bodies.index(second)
    return max(numbers), min(numbers)


def write_centrodes_csv(mechanism: Mechanism, centrodes: xarray.Dataset, path: Path) -> None:
    """Write both centrodes as CSV: one row a sample, in the units of the display."""
    names = ("fixed_centrode", "moving_centrode")
    factor, columns = _places(mechanism, names)
    length, unit = shown_as("m" if mechanism.space == "plane" else "rad", mechanism.display)
    header = [*_instant_header(mechanism, centrodes), *columns]
    header += ["piece", f"fixed_arc [{unit}]", f"moving_arc [{unit}]", "status"]
    curves = [factor * centrodes[name].to_numpy() for name in names]
    arcs = [length * centrodes[name].to_numpy() for name in ("fixed_arc", "moving_arc")]
    pieces, statuses = centrodes["centrode_piece"].to_numpy(), centrodes["status"].to_numpy()
    rows: Iterable[list[float | str]] = (
        [
            *instant,
            *(float(x) for curve in curves for x in curve[k]),
            str(pieces[k]) if pieces[k] >= 0 else "",
            *(float(arc[k]) for arc in arcs),
            Status(int(statuses[k])).word,
        ]
        for k, instant in enumerate(_instants(mechanism, centrodes))
    )
    _write(path, header, rows)


def _places(mechanism: Mechanism, names: Sequence[str]) -> tuple[float, list[str]]:
    """Factor of places, and the headings of their columns: unit vectors on the sphere."""
    if mechanism.space == "sphere":
        return 1.0, [f"{name}_{axis}" for name in names for axis in "xyz"]
    factor, unit = shown_as("m", mechanism.display)
    return factor, [f"{name}_{axis} [{unit}]" for name in names for axis in "xy"]


def _instant_header(mechanism: Mechanism, data: xarray.Dataset) -> list[str]:
    drives = [str(name) for name in data["drive"].values]
    units = [
        shown_as(mechanism.motion_parameter.drives[k].unit, mechanism.display)[1] for k in range(len(drives))
    ]
    return ["time [s]", *(f"drive_{name} [{unit}]" for name, unit in zip(drives, units, strict=True))]


def _instants(mechanism: Mechanism, data: xarray.Dataset) -> list[list[float]]:
    """Time and values of the drives of each sample."""
    factors = [
        shown_as(mechanism.motion_parameter.drives[k].unit, mechanism.display)[0]
        for k in range(data.sizes["drive"])
    ]
    values = data["drive_value"].to_numpy() * factors
    return [
        [float(time), *map(float, row)] for time, row in zip(data["time"].to_numpy(), values, strict=True)
    ]


def _write(path: Path, header: Sequence[str], rows: Iterable[Sequence[float | str]]) -> None:
    with Path(path).open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(map(field, row) for row in rows)
