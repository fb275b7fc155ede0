"""Traced plans of one mechanism on disk: another process neither traces nor compiles them again.

An entry is run as native code: who may have written one, and what is wrong with one, is judged in `cache`.
"""

from __future__ import annotations

import functools
import hashlib
import json
import sys
from collections.abc import Mapping, Sequence
from itertools import accumulate, pairwise
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.machine_code.frame_kernels import (
    FrameLayout,
    FreeNumbers,
    MeshLayout,
    PlaceScan,
    RoomQuantity,
    frame_kernels,
    frame_places,
    rows_along,
)
from centrode.kinematics.machine_code.frame_plan import DirectPlan, FreeMechanism
from centrode.model.files import document
from centrode.numerics.executors import (
    MACHINE_CODE,
    StreamerRecord,
    code_circumstances,
    streamer_of_record,
    streamer_record,
)
from centrode.numerics.graphs import graph_of_rows, graph_rows
from centrode.numerics.machine_code import cache
from centrode.version import __version__

Array: TypeAlias = npt.NDArray[np.float64]
Record: TypeAlias = dict[str, Any]
PACKAGE = Path(__file__).parents[2]
ROOMS = ("geometry", "kinematics", "laws", "model", "numerics", "structure")
"""Rooms of the package whose sources make a trace."""


def kept_plan(free: FreeMechanism) -> DirectPlan | None:
    """The plan of a mechanism from disk; None where it is not there, or not to be trusted."""
    name = entry_name(free)
    content = None if name is None else cache.read_entry(name)
    if content is None:
        return None
    try:
        return _plan(free, *_split(content))
    except (ValueError, KeyError, TypeError, IndexError, RuntimeError):
        return None


def keep_plan(plan: DirectPlan) -> None:
    """Keep a plan of machine code on disk, if it can be kept."""
    name = entry_name(plan.free) if plan.executor == MACHINE_CODE else None
    if name is not None:
        cache.write(name, _content(plan))


def entry_name(free: FreeMechanism) -> str | None:
    """Name of the entry of a plan: all that its trace and its code depend on; None where that cannot be told."""
    sources = sources_digest()
    if cache.folder() is None or sources is None:
        return None
    try:
        # SI numbers with all their digits, in the order of the description: texts with units would round them
        described = json.dumps(document(free.ready.mechanism))
    except (TypeError, ValueError):
        return None
    span = free.span
    grid = [
        np.ascontiguousarray(x).tobytes() for x in (span.time, span.parameter, span.rate, span.second_rate)
    ]
    return cache.name_of(
        "plan of one mechanism", described, json.dumps(free.paths), hashlib.sha256(b"".join(grid)).hexdigest(),
        __version__, np.__version__, sys.version, *code_circumstances(), sources,
    )  # fmt: skip


@functools.cache
def sources_digest() -> str | None:
    """Digest of the sources that make a trace; None where they are not there to be read.

    A version is not enough: who works on the package changes what it traces, not its version.
    """
    places = [place for room in ROOMS for place in sorted((PACKAGE / room).rglob("*.py"))]
    digest = hashlib.sha256()
    try:
        for place in places:
            content = place.read_bytes()
            digest.update(f"{place.relative_to(PACKAGE).as_posix()} {len(content)}:".encode() + content)
    except OSError:
        return None
    return digest.hexdigest() if places else None


# A plan as bytes: a line of JSON, then the object code of its two scans.


def _content(plan: DirectPlan) -> bytes:
    numbers, layout = plan.numbers, plan.layout
    records = [streamer_record(scan.take) for scan in plan.kernels.scans]
    head: Record = {
        "copied": dict(numbers.copied),
        "turned": {name: list(rule) for name, rule in numbers.turned.items()},
        "scale": None if numbers.scale is None else graph_rows(numbers.scale),
        "least": layout.mesh.least,
        "greatest": layout.mesh.greatest,
        "links": layout.mesh.links,
        "winders": graph_rows(layout.winders),
        "quantities": [[x.name, x.first, list(x.shape)] for x in layout.quantities],
        "angles": [int(row) for row in layout.angles],
        "scans": [record for record, _code in records],
        "bytes": [len(code) for _record, code in records],
    }
    return json.dumps(head).encode() + b"\n" + b"".join(code for _record, code in records)


def _split(content: bytes) -> tuple[Record, list[StreamerRecord]]:
    line, _end, code = content.partition(b"\n")
    head = json.loads(line)
    ends = [0, *accumulate(map(int, head["bytes"]))]
    if len(code) != ends[-1]:
        raise ValueError("object code of another length")
    parts = [code[first:last] for first, last in pairwise(ends)]
    return head, list(zip(head["scans"], parts, strict=True))


def _plan(free: FreeMechanism, head: Record, records: Sequence[StreamerRecord]) -> DirectPlan:
    scale = None if head["scale"] is None else graph_of_rows(head["scale"])
    turned = {name: (int(k), str(function)) for name, (k, function) in head["turned"].items()}
    numbers = FreeNumbers(free.paths, {name: int(k) for name, k in head["copied"].items()}, turned, scale)
    mesh = MeshLayout(tuple(head["least"]), tuple(head["greatest"]), tuple(head["links"]))
    quantities = tuple(
        RoomQuantity(name, int(first), tuple(shape)) for name, first, shape in head["quantities"]
    )
    layout = FrameLayout(mesh, graph_of_rows(head["winders"]), quantities, tuple(head["angles"]))
    places = frame_places(free.ready, free.span).all
    scans = [_place_scan(record, at) for record, at in zip(records, places, strict=True)]
    judge, turning, write = scans
    # machine code writes to addresses: rooms have to have the rows that the layout speaks of
    rows = max((x.rows.stop for x in quantities), default=0)
    judged = len(mesh.least) + len(mesh.greatest)
    if judge.count != judged or turning.count != len(mesh.links) or write.count < rows:
        raise ValueError("rows of another plan")
    kernels = frame_kernels(free.ready, free.span, layout, scans)
    return DirectPlan(free, numbers, layout, kernels, MACHINE_CODE)


def _place_scan(record: StreamerRecord, places: Mapping[str, Array]) -> PlaceScan:
    head = record[0]
    along = rows_along(head["parameters"], places)
    take = streamer_of_record(record, along)
    return PlaceScan(tuple(head["inputs"]), int(head["outputs"]), take, along.shape[1])
