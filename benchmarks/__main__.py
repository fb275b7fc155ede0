"""`python -m benchmarks [SECTION ...]`: print all ratios, or those of some sections."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Iterator, Mapping

# lazy_loader remarks that a submodule loads its package; here nothing is gained by loading only the package late
warnings.filterwarnings(
    "ignore", message="subpackages can technically be lazily loaded", category=RuntimeWarning
)

from tools.node import MISSING, NODE  # noqa: E402

from benchmarks import (  # noqa: E402
    animations,
    chains,
    cluster,
    cold,
    drawings,
    events,
    forces,
    free_motions,
    kernels,
    machine,
    motions,
    pages,
    peer,
    reports,
    simulation,
    solver,
    sweeps,
    synthesis,
    tolerances,
    workbench,
)
from benchmarks.plans import LANES, SAMPLES  # noqa: E402
from benchmarks.table import Row, print_promises, print_section  # noqa: E402
from centrode.numerics import machine_code  # noqa: E402

Section = tuple[str, Callable[[], Iterator[Row]]]
SECTIONS: Mapping[str, Section] = {
    "worked": (
        f"Worked mechanisms, {motions.SAMPLES} samples: centrode's time over pylinkage's", motions.worked_mechanisms,
    ),
    "batch": (
        f"Batches, {motions.SAMPLES} samples, with derivatives: centrode's time over pylinkage's", motions.batches,
    ),
    "single": (f"One motion, {motions.SAMPLES} samples, labels included", motions.single_motions),
    "forces": (f"Reduction to the drive, {forces.SAMPLES} samples", forces.reductions),
    "reactions": (f"Reactions in all joints, {forces.SAMPLES} samples", forces.reactions),
    "force peers": (
        "Joint forces, a peer's time over centrode's, and how far the forces are apart", forces.against_peers,
    ),
    "simulation": (f"Simulation, {simulation.STEPS} fixed steps", simulation.simulations),
    "free motions": ("Forward dynamics beside MuJoCo, times by the clock", free_motions.free_motions),
    "events": ("Events of a motion, times by the clock", events.events),
    "cold": (f"Whole processes, multiples of {cold.BASE}", cold.cold_starts),
    "animations": (f"Animations, {animations.FRAMES} frames of 800 by 600 pixels", animations.animations),
    "drawings": ("Commands that draw, whole processes", drawings.drawings),
    "reports": ("Thirty reports of the assignment's table, two processes", reports.thirty_reports),
    "chains": ("All kinematic chains of some links, mobility 1", chains.chain_lists),
    "machine": ("Bounds of the machine", machine.bounds),
    "kernels": (
        f"Machine code, {LANES} mechanisms of {SAMPLES} samples, a position", kernels.kernels,
    ),
    "solver": (f"One mechanism whose numbers change, {solver.SAMPLES} samples", solver.moves),
    "cluster": ("A sweep on two workers of this machine, by the clock", cluster.clusters),
    "page": (f"A page in Node: changed numbers to a motion of {pages.SAMPLES} samples", pages.recomputes),
    "workbench": (f"A joint dragged in the workbench, {workbench.STEPS} steps", workbench.drags),
    "synthesis": ("Synthesis: published paths and functions, times by the clock", synthesis.synthesis),
    "tolerances": ("Tolerances, one output", tolerances.tolerances),
    "sweeps": (f"Sweeps as machine code, {sweeps.SAMPLES} samples, a position", sweeps.sweeps),
}  # fmt: skip
NEED_PEER = {"worked", "batch"}
NEED_NODE = {"page"}
NEED_BROWSER = {"workbench"}
NEED_COMPILER = {"kernels", "sweeps", "tolerances", "simulation", "cluster"}


def main(wanted: list[str]) -> int:
    """Print the sections wanted, all if none is named, and what they promise; 1 if a promise is not held."""
    unknown = [name for name in wanted if name not in SECTIONS]
    if unknown:
        print(f"unknown: {', '.join(unknown)}; sections are {', '.join(SECTIONS)}", file=sys.stderr)
        return 2
    rows: list[Row] = []
    for name in wanted or SECTIONS:
        title, measure = SECTIONS[name]
        if name in NEED_PEER and not peer.PRESENT:
            print(f"\n{title}\n  left out: {peer.MISSING}")
            continue
        if name in NEED_COMPILER and not machine_code.PRESENT:
            print(f"\n{title}\n  left out: {kernels.MISSING}")
            continue
        if name in NEED_NODE and NODE is None:
            print(f"\n{title}\n  left out: {MISSING}")
            continue
        if name in NEED_BROWSER and not workbench.PRESENT:
            print(f"\n{title}\n  left out: {workbench.MISSING}")
            continue
        rows += print_section(title, measure())
    return 0 if print_promises(rows) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
