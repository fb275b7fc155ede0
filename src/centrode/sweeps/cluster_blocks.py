"""Blocks of a sweep on a cluster: what a worker is told as text, how it computes a block, and who counts them.

The text stands in the store, so a worker is given its digest and the number of a block; it makes the plan once.
"""

from __future__ import annotations

import hashlib
import json
import threading
from collections import OrderedDict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.files import parse_mechanism
from centrode.numerics.executors import lacking_features
from centrode.sweeps.clusters import ClusterSource, libraries, open_cluster
from centrode.sweeps.designs import Crossed, Design, Listed
from centrode.sweeps.drawn_designs import DrawnDesigns
from centrode.sweeps.executors import bare
from centrode.sweeps.storage import PROGRESS, Storage, place_refusals, storage_of, zarr_array
from centrode.sweeps.store import Blocks, BlockWriter, Store, Tally
from centrode.sweeps.sweep_plans import Progress, Span, SweepPlan, plan_of

WORK = f"{PROGRESS}/work.json"
MOST_TEXT = 200_000_000
"""Bytes of the text of a sweep; tables of numbers at the samples are the most of it."""
REMEMBERED = 4
"""Plans that a worker keeps."""


# The text.


def work_text(
    plan: SweepPlan,
    outputs: Any,
    reduce: Any,
    gradient: bool,
    span: Span,
    wanted: Mapping[str, str | None],
    blocks: Blocks,
) -> str:
    """All that a worker makes the plan of, as JSON; values of a listed or a crossed design stand in the store."""
    frame, asked = plan.frame, plan.task.asked
    told = {
        "libraries": dict(wanted),
        "target": plan.target,
        "mechanism": frame.empty.attrs["mechanism"],
        "design": _design_text(frame.design),
        "outputs": dict(outputs)
        if isinstance(outputs, Mapping)
        else outputs
        if outputs is None
        else _plain_outputs(outputs),
        "reduce": dict(reduce) if isinstance(reduce, Mapping) else reduce,
        "gradient": gradient,
        "samples": [_plain(end) for end in span],
        "tables": {
            name: [None if np.isnan(x) else float(x) for x in table.numbers]
            for name, table in asked.tables.items()
        }
        or None,
        "executor": bare(str(frame.empty.attrs["executor"])),
        "blocks": [blocks.axis, blocks.step],
    }
    return json.dumps(told, sort_keys=True)


def _plain_outputs(outputs: Any) -> Any:
    return outputs if isinstance(outputs, str) else list(outputs)


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value


def _design_text(design: Design) -> dict[str, Any]:
    if isinstance(design, DrawnDesigns):
        return {"drawn": design.text}
    return {"crossed" if isinstance(design, Crossed) else "listed": list(design.paths)}


def _design_of(told: Mapping[str, Any], storage: Storage) -> Design:
    if "drawn" in told:
        return DrawnDesigns.of_text(told["drawn"])
    kind = "crossed" if "crossed" in told else "listed"
    values = {path: np.asarray(zarr_array(storage, path), np.float64) for path in told[kind]}
    return Crossed(values) if kind == "crossed" else Listed(values)


# On a worker.


@dataclass(frozen=True)
class _Workplace:
    """A plan and where its blocks go, in the process of a worker."""

    plan: SweepPlan
    writer: BlockWriter


_workplaces: OrderedDict[tuple[str, str], _Workplace] = OrderedDict()
_one_at_a_time = threading.Lock()


def compute_block(text: str) -> dict[str, Any]:
    """Compute one block and write it to its store; returns what it comes to."""
    told = json.loads(text)
    work = _workplace(told["store"], told["digest"])
    blocks = work.writer.blocks
    first, stop = blocks.mechanisms(told["block"])
    results = work.plan.frame.room(stop - first)
    tally = work.plan.compute(first, stop, results, _nothing)
    work.writer.write(told["block"], results, tally)
    return tally.as_dict()


def _nothing(done: int) -> None:
    """Progress is told by whole blocks."""


def _workplace(store: str, digest: str) -> _Workplace:
    key = store, digest
    # several threads of a worker wait for the plan that one of them makes
    with _one_at_a_time:
        if key not in _workplaces:
            _workplaces[key] = _make_workplace(storage_of(store), digest)
            while len(_workplaces) > REMEMBERED:
                _workplaces.popitem(last=False)
        return _workplaces[key]


def _make_workplace(storage: Storage, digest: str) -> _Workplace:
    content = storage.read(WORK, MOST_TEXT)
    if content is None or hashlib.sha256(content).hexdigest() != digest:
        what = _("the store of the sweep is not there")
        raise InputError(
            str(storage), what, _("name a store that all workers reach by the same path or address")
        )
    told = json.loads(content)
    target = told["target"]
    lacking = () if target is None else lacking_features(target)
    if lacking:
        what = _("it cannot run code for {target}: it has no {features}")
        repair = _("leave this worker out, or begin another store for an older processor")
        raise InputError("", what.format(target=target, features=", ".join(lacking)), repair)
    tables = told["tables"]
    plan = plan_of(
        parse_mechanism(told["mechanism"]),
        _design_of(told["design"], storage),
        told["executor"],
        told["outputs"],
        told["reduce"],
        told["gradient"],
        tables and {name: [np.nan if x is None else x for x in values] for name, values in tables.items()},
        tuple(told["samples"]),
        target=target,
    )
    axis, step = told["blocks"]
    return _Workplace(plan, BlockWriter(storage, plan.frame, Blocks(plan.frame.design.shape, axis, step)))


# In the process that began the sweep.


def compute_on_cluster(
    store: Store,
    text: str,
    wanted: Mapping[str, str | None],
    cluster: ClusterSource,
    progress: Progress | None,
) -> None:
    """Compute the blocks that a store does not have on a cluster; its text is kept in the store."""
    storage, blocks = store.storage, store.blocks
    with place_refusals(str(storage)):
        if storage.read(WORK, MOST_TEXT) != text.encode():
            storage.write(WORK, text.encode())
        digest = hashlib.sha256(text.encode()).hexdigest()
        if store.tally.mechanisms == store.frame.mechanisms:
            return
        components = {column.name: int(np.prod(column.shape)) for column in store.frame.asked.columns}
        with open_cluster(cluster) as workers:
            if progress is not None:
                progress(store.tally.mechanisms, store.frame.mechanisms)
            for block, told in workers.answers(compute_block, _texts(store, digest), wanted):
                first, stop = blocks.mechanisms(block)
                tally = Tally.from_dict(told, components)
                assert tally.mechanisms == stop - first
                store.take(block, tally)
                if progress is not None:
                    progress(store.tally.mechanisms, store.frame.mechanisms)


def _texts(store: Store, digest: str) -> Iterator[tuple[int, str]]:
    for block in store.blocks:
        if not store.has(block):
            told = {"store": store.storage.url, "digest": digest, "block": block}
            yield block, json.dumps(told)


def check_libraries(storage: Storage, wanted: Mapping[str, str | None]) -> None:
    """InputError where a store was begun on a cluster by other versions than this process has."""
    content = storage.read(WORK, MOST_TEXT)
    if content is None:
        return
    began = json.loads(content)["libraries"]
    own = libraries()
    other = [name for name in began if began[name] != own.get(name) and name in wanted]
    if other:
        what = _("it was begun with {theirs}; here is {own}").format(
            theirs=", ".join(f"{name} {began[name]}" for name in other),
            own=", ".join(f"{name} {own.get(name)}" for name in other),
        )
        raise InputError(str(storage), what, _("install the same versions, or give another path"))
