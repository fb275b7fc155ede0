"""Work on a cluster, by Dask's `distributed`: workers get the name of a function and a text, and give a text back.

A worker is looked at before it computes: it has the versions that are asked for, or it is refused by name. Work whose
worker dies goes to another one. What a function does may be done twice, so it has to end in the same bytes.
"""

from __future__ import annotations

import functools
import importlib
import importlib.metadata
import importlib.util
import json
import logging
import queue
import signal
import socket
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from centrode.errors import CentrodeError, ClusterWarning, InputError
from centrode.locale import _
from centrode.model.reading import value_text
from centrode.optional_packages import admitted_module, how_to_install
from centrode.version import __version__

ClusterSource: TypeAlias = Any
"""A number of workers on this machine, the address of a scheduler (tcp://, tls://), or a client of `distributed`."""
Work: TypeAlias = Callable[[str], Any]
"""A function of a module of centrode; what it returns JSON can hold."""
Wanted: TypeAlias = Mapping[str, str | None]
"""Library -> the version that workers must have."""

MOST_WORKERS = 256
"""Workers on one machine."""
CONNECTING = 10.0
"""Seconds in which a scheduler has to answer."""
RETRIES = 3
"""Times that a piece of work is tried again after a failure of a store or a network."""
DEATHS = 10
"""Workers that may die over one piece of work before it counts as the cause."""
WAITING, LEAST_WAITING = 3, 16
"""Pieces of work that are handed out for each thread of the cluster, and at least."""
PATIENCE = 10.0
"""Seconds without a worker after which that is told."""
TICK = 0.5
"""Seconds between looks at the scheduler while nothing is finished."""
OF_WORKERS: Mapping[str, Any] = {
    "distributed.scheduler.allowed-failures": DEATHS,
    # a look at the stack of the computing thread each 10 ms, which nobody reads
    "distributed.worker.profile.enabled": False,
    # without a low MALLOC_TRIM_THRESHOLD_, by which each array of a kernel would be fetched from the system anew
    "distributed.nanny.pre-spawn-environ": {
        "OMP_NUM_THREADS": 1,
        "MKL_NUM_THREADS": 1,
        "OPENBLAS_NUM_THREADS": 1,
    },
}
"""Settings of `distributed` for workers of this machine."""
OF_CONNECTION = ("ClosedClientError", "CancelledError", "FutureCancelledError", "FuturesCancelledError")
"""Failures of a client whose scheduler is gone."""

# heavy, an extra
_distributed = functools.partial(admitted_module, "distributed", "dask")
_dask = functools.partial(admitted_module, "dask", "dask")
_resource_tracker = functools.partial(importlib.import_module, "multiprocessing.resource_tracker")


# What workers must have.

NUMPY_KERNELS = "NumPy's kernels"
FUNCTIONS = "^(sin|cos|tan|arcsin|arccos|arctan|arctan2|exp|exp2|log|log2|power|sqrt|hypot|tanh)$"


def libraries() -> dict[str, str | None]:
    """What the bits of results depend on: versions of libraries, and the kernels that NumPy takes on this processor."""
    try:
        llvmlite = importlib.metadata.version("llvmlite")
    except importlib.metadata.PackageNotFoundError:
        llvmlite = None
    return {
        "centrode": __version__,
        "NumPy": np.__version__,
        "llvmlite": llvmlite,
        NUMPY_KERNELS: _kernels_of_numpy(),
    }


@functools.cache
def _kernels_of_numpy() -> str:
    told = np.lib.introspect.opt_func_info(func_name=FUNCTIONS, signature="float64")
    return " ".join(sorted({kernel["current"] for function in told.values() for kernel in function.values()}))


def wanted_libraries(*, machine_code: bool) -> dict[str, str | None]:
    """The libraries that workers must have as this process has them; llvmlite where it computes."""
    return {name: version for name, version in libraries().items() if machine_code or name != "llvmlite"}


# On a worker.

FOUND, REFUSED, FAILED = "found", "refused", "failed"


def answer(function: Work, wanted: Wanted, text: str) -> str:
    """What a function gives for a text, as JSON; or why this worker cannot compute it."""
    own = libraries()
    other = {name: own.get(name) for name, version in wanted.items() if own.get(name) != version}
    if other:
        return json.dumps({REFUSED: other, "worker": socket.gethostname()})
    try:
        return json.dumps({FOUND: function(text)})
    except CentrodeError as failure:
        told = [failure.where, failure.what, failure.repair]
        return json.dumps({FAILED: told, "worker": socket.gethostname()})


# The cluster.


@dataclass(frozen=True)
class Cluster:
    """A cluster that is reached.

    Attributes
    ----------
    client : of `distributed`
    name : as messages name it
    """

    client: Any
    name: str

    def answers(
        self, function: Work, texts: Iterable[tuple[int, str]], wanted: Wanted
    ) -> Iterator[tuple[int, Any]]:
        """(number, what the function gives) of numbered texts, in the order in which they are finished.

        Raises InputError: a worker has other versions, the function fails, workers die of it, the scheduler goes away.
        OSError where it fails with one again and again. Then, and when the iteration is given up, nothing more is
        begun.
        """
        work = _Running(self, function, dict(wanted))
        waiting = iter(texts)
        try:
            with self._tell_of_losses():
                work.fill(waiting)
            while work.running:
                with self._tell_of_losses():
                    ready = work.ready()
                yield from ready
                with self._tell_of_losses():
                    work.fill(waiting)
        finally:
            work.give_up()

    @contextmanager
    def _tell_of_losses(self) -> Iterator[None]:
        """What the client says when its scheduler is gone, as InputError."""
        try:
            yield
        except (CentrodeError, KeyboardInterrupt):
            raise
        except Exception as failure:
            if self.client.status != "running" or _is_of_connection(failure):
                raise self.lost() from failure
            raise

    def lost(self) -> InputError:
        """The scheduler went away."""
        what = _("the scheduler went away")
        return InputError(
            self.name, what, _("finished results are kept; the same command resumes from there")
        )

    def threads(self) -> int:
        """Threads of all workers."""
        return sum(self.client.nthreads().values())


class _Running:
    """The work that is handed out."""

    def __init__(self, cluster: Cluster, function: Work, wanted: dict[str, str | None]) -> None:
        self.cluster = cluster
        self.function = function
        self.wanted = wanted
        self.running: dict[Any, tuple[int, str, int]] = {}
        self._ready: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._most = 0
        self._alone = 0.0

    def fill(self, waiting: Iterator[tuple[int, str]]) -> None:
        """Hand out as much as keeps the cluster busy; the list of all that is to be done may be long."""
        if len(self.running) >= self._most // 2:
            self._most = max(LEAST_WAITING, WAITING * self.cluster.threads())
        while len(self.running) < self._most:
            entry = next(waiting, None)
            if entry is None:
                return
            self._hand_out(*entry, 0)

    def _hand_out(self, number: int, text: str, deaths: int) -> None:
        future = self.cluster.client.submit(
            answer, self.function, self.wanted, text, pure=False, retries=RETRIES
        )
        self.running[future] = number, text, deaths
        future.add_done_callback(self._ready.put)

    def ready(self) -> list[tuple[int, Any]]:
        """What is finished now; some of it at least, or nothing after a while."""
        futures = self._wait()
        finished = [future for future in futures if future.status == "finished"]
        found = [
            (self.running.pop(future)[0], self._answer_of(json.loads(text)))
            for future, text in zip(finished, self.cluster.client.gather(finished), strict=True)
        ]
        for future in futures:
            if future in self.running:
                self._again(future)
        return found

    def _wait(self) -> list[Any]:
        try:
            futures = [self._ready.get(timeout=TICK)]
        except queue.Empty:
            self._tell_of_no_workers()
            if self.cluster.client.status != "running":
                raise self.cluster.lost() from None
            return []
        # all that is there is fetched at once
        with suppress(queue.Empty):
            while True:
                futures.append(self._ready.get_nowait())
        return [future for future in futures if future in self.running]

    def _tell_of_no_workers(self) -> None:
        if self.cluster.threads():
            self._alone = 0.0
            return
        before, self._alone = self._alone, self._alone + TICK
        if before < PATIENCE <= self._alone:
            what = _("{scheduler} has no workers; the work waits for them").format(
                scheduler=self.cluster.name
            )
            warnings.warn(what, ClusterWarning, stacklevel=6)

    def _again(self, future: Any) -> None:
        """Hand out once more what a worker died over; whatever else was wrong is raised."""
        number, text, deaths = self.running.pop(future)
        if future.status != "error":
            raise self.cluster.lost()
        failure = future.exception()
        if isinstance(failure, ModuleNotFoundError) and (failure.name or "").partition(".")[0] == "centrode":
            raise _refusal("", {"centrode": None}, self.wanted)
        if type(failure).__name__ != "KilledWorker":
            raise failure
        if deaths + 1 >= DEATHS:
            what = _("work number {number} ended {count} workers").format(number=number, count=deaths + 1)
            raise InputError(self.cluster.name, what, _("give workers more memory"))
        self._hand_out(number, text, deaths + 1)

    def _answer_of(self, told: Mapping[str, Any]) -> Any:
        if REFUSED in told:
            raise _refusal(told["worker"], told[REFUSED], self.wanted)
        if FAILED in told:
            where, what, repair = told[FAILED]
            name = _("worker {worker}").format(worker=told["worker"])
            raise InputError(", ".join(filter(None, (name, where))), what, repair)
        return told[FOUND]

    def give_up(self) -> None:
        """Begin nothing more; what workers are at they finish by themselves."""
        if self.running:
            with suppress(Exception):
                self.cluster.client.cancel(list(self.running))
        self.running.clear()


def _refusal(worker: str, theirs: Wanted, wanted: Wanted) -> InputError:
    """A worker has other versions: both are named."""
    where = _("worker {worker}").format(worker=worker) if worker else _("a worker")
    told = ", ".join(
        _("{library} {theirs}, {wanted} is needed").format(
            library=name, theirs=theirs[name] or _("missing"), wanted=wanted.get(name) or _("missing")
        )
        for name in theirs
    )
    if set(theirs) == {NUMPY_KERNELS}:
        names = " ".join(
            sorted(set(f"{theirs[NUMPY_KERNELS]}".split()) ^ set(f"{wanted[NUMPY_KERNELS]}".split()))
        )
        repair = _('set the variable NPY_DISABLE_CPU_FEATURES="{names}" for all workers and for this command')
        return InputError(where, told, repair.format(names=names))
    return InputError(where, told, _("install the same versions on all workers"))


def _is_of_connection(failure: BaseException) -> bool:
    """Whether the client has lost its scheduler."""
    if isinstance(failure, OSError):
        # CommClosedError is one; a store's failures come from workers
        return type(failure).__module__.startswith("distributed")
    return type(failure).__name__ in OF_CONNECTION


def check_cluster(cluster: ClusterSource) -> ClusterSource:
    """What a cluster may be given as; InputError for anything else, and where the extra is not installed."""
    if isinstance(cluster, bool) or cluster is None:
        raise _unknown(cluster)
    if isinstance(cluster, int):
        if not 1 <= cluster <= MOST_WORKERS:
            what = _("{count} is not a valid number of workers").format(count=cluster)
            raise InputError(
                "cluster", what, _("give a whole number from 1 to {most}").format(most=MOST_WORKERS)
            )
    elif isinstance(cluster, str):
        if not cluster.startswith(("tcp://", "tls://")):
            raise _unknown(cluster)
    elif type(cluster).__module__.partition(".")[0] not in {"distributed", "dask"} or not hasattr(
        cluster, "submit"
    ):
        raise _unknown(cluster)
    if importlib.util.find_spec("distributed") is None:
        what = _("a cluster needs distributed, which is not installed")
        raise InputError("cluster", what, how_to_install("cluster"))
    return cluster


def _unknown(cluster: object) -> InputError:
    what = _("{value} is no cluster").format(value=value_text(cluster))
    repair = _("give a number of workers, an address such as tcp://host:8786, or a client of distributed")
    return InputError("cluster", what, repair)


@contextmanager
def open_cluster(cluster: ClusterSource) -> Iterator[Cluster]:
    """The cluster that was given; workers of this machine live as long as the block runs, a client is left open.

    Raises InputError where nothing answers at an address.
    """
    cluster = check_cluster(cluster)
    with ExitStack() as stack:
        if isinstance(cluster, int):
            stack.enter_context(_quiet())
            local = stack.enter_context(_local(cluster))
            client = stack.enter_context(_distributed().Client(local, set_as_default=False))
            yield Cluster(client, _("workers of this machine"))
        elif isinstance(cluster, str):
            stack.enter_context(_quiet())
            client = _client_of(cluster)
            stack.callback(_close, client)
            yield Cluster(client, cluster)
        else:
            yield Cluster(cluster, str(getattr(cluster.scheduler, "address", "") or _("the scheduler")))


@contextmanager
def _local(count: int) -> Iterator[Any]:
    # imported first: its own settings come with it, and would go with the block
    distributed = _distributed()
    with _dask().config.set(OF_WORKERS):
        machines = distributed.LocalCluster(
            n_workers=0, threads_per_worker=1, processes=True, dashboard_address="127.0.0.1:0", host="127.0.0.1",
            silence_logs=logging.CRITICAL,
        )  # fmt: skip
    with machines:
        machines.sync(_leave_interrupts_to_the_client)
        with _dask().config.set(OF_WORKERS):
            machines.scale(count)
            machines.wait_for_workers(count)
        yield machines


async def _leave_interrupts_to_the_client() -> None:
    """Ctrl-C reaches all processes of a terminal: workers, begun by this thread, take the mask of it and go on."""
    if hasattr(signal, "pthread_sigmask"):
        # where it is begun by the first worker it takes the mask away from the thread
        _resource_tracker().ensure_running()
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})


CERTIFICATES = "DASK_DISTRIBUTED__COMM__TLS__CA_FILE, ..._CLIENT__CERT, ..._CLIENT__KEY"
"""Variables that name the files of certificates, see `distributed.comm.tls` in the settings of `distributed`."""


def _check_certificates(address: str) -> None:
    """InputError where an address needs certificates and the settings of `distributed` give none that can be read."""
    if not address.startswith("tls://") or _dask().config.get("distributed.client.security-loader", None):
        return
    repair = _("name their files in the settings of distributed: {variables}").format(variables=CERTIFICATES)
    try:
        context = _distributed().Security().get_connection_args("client")["ssl_context"]
    except OSError as failure:
        # of a certificate that is none too: failures of TLS are of this kind
        what = _("the certificates cannot be read: {reason}").format(reason=failure.strerror or failure)
        raise InputError(address, what, repair) from failure
    if context is None:
        raise InputError(address, _("an address of this kind needs certificates"), repair)


def _client_of(address: str) -> Any:
    _check_certificates(address)
    try:
        return _distributed().Client(address, timeout=CONNECTING, set_as_default=False)
    except (OSError, ValueError, TypeError) as failure:
        reason = str(failure).partition("\n")[0] or type(failure).__name__
        what = _("no scheduler answers there: {reason}").format(reason=reason)
        raise InputError(
            address, what, _("look at the address, or start one with: dask scheduler")
        ) from failure


def _close(client: Any) -> None:
    # a scheduler that is gone takes its time to say so
    with suppress(Exception):
        client.close(timeout=2)


@contextmanager
def _quiet() -> Iterator[None]:
    """What `distributed` writes of workers that die is no news: it is told where it matters."""
    _distributed()  # its loggers come with it; some have levels of their own, which that of their parent does not reach
    names = [name for name in logging.root.manager.loggerDict if name.partition(".")[0] == "distributed"]
    before = {name: logging.getLogger(name).level for name in names}
    for name in names:
        logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        for name, level in before.items():
            logging.getLogger(name).setLevel(level)
