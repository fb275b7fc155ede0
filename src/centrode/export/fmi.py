"""A mechanism with one drive as a unit of co-simulation and model exchange (FMI 3.0), as C source.

The forward dynamics is the reduced equation J q'' + J' q'^2 / 2 = M + M_drive, whose J, J' and M are printed from the
graph of the reduction; the driven motion is a function of the drive's value, speed and acceleration.
"""

from __future__ import annotations

import hashlib
import platform
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import pi
from pathlib import Path
from typing import TypeAlias

from centrode.dynamics.masses import has_masses_or_loads
from centrode.dynamics.simulation.routes import MULTIBODY, equations_for
from centrode.errors import InputError, NotComputedYet
from centrode.export.code_files import source_text
from centrode.export.fmi_archive import (
    FIRST_DIMENSION,
    FIRST_INPUT,
    STATUS,
    Fmu,
    FmuVariable,
    archive_of,
    chosen_outputs,
    derivative_variable,
    engine,
    input_variable,
    numbers_text,
    output_variable,
    state_variable,
)
from centrode.export.fmi_links import free_fmu
from centrode.export.motion_program import MotionProgram, traced_program
from centrode.kinematics.preparation import ready
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.simulation import Simulation
from centrode.numerics.graphs import Unwritten
from centrode.numerics.source_languages import LANGUAGES

End: TypeAlias = float | str | None

ANGLES = ("angle", "joint_angle", "hinge_angle")


@dataclass(frozen=True)
class FmuProgram:
    """A mechanism as an FMU: its printed program, its outputs, and whether its drive is free."""

    program: MotionProgram
    outputs: tuple[int, ...]
    dynamic: bool
    shaft_inertia: float = 0.0

    @property
    def name(self) -> str:
        """Identifier of the model."""
        return self.program.name

    @cached_property
    def source(self) -> str:
        """One C file with everything."""
        program = self.program
        name, turning = program.name, program.ready.kinematics.path.turns
        known = LANGUAGES["c"].notation.number
        results = [program.results[k] for k in self.outputs]
        wraps = bool(turning and not program.traced.counted)
        inputs = [0.0] if self.dynamic else [self.start, self.speed, 0.0]
        states = [self.start, self.speed] if self.dynamic else []
        defines: Mapping[str, str] = {
            "MODEL": name, "PREPARE": f"{name}_prepare", "AT": f"{name}_at", "MODEL_DIMENSIONS": f"{name}_dimensions",
            "OUTPUTS": str(len(results)), "PARAMETERS": str(len(program.paths)), "DYNAMIC": str(int(self.dynamic)),
            "WRAPS": str(int(wraps)), "PERIOD": known(2.0 * pi)[0], "INPUTS": str(len(inputs)),
            "START_INPUTS": numbers_text(inputs), "STATES": str(len(states)), "START_STATES": numbers_text(states),
            "FIRST_PLACE": known(float(program.numbers["initial"]))[0], "SHAFT_INERTIA": known(self.shaft_inertia)[0],
            "DRIVE_UNIT": known(float(program.numbers["unit"]))[0], "TOKEN": f'"{self.token}"',
        }  # fmt: skip
        rows = ", ".join(str(k) for k in self.outputs) or "0"
        turned = ", ".join(str(int(x.quantity in ANGLES)) for x in results) or "0"
        return "\n".join(
            [
                self._motion,
                *(f"#define {word} {text}" for word, text in defines.items()),
                f"static const int output_rows[] = {{{rows}}};",
                f"static const int output_turns[] = {{{turned}}};",
                engine("fmi3_drive.c"),
            ]
        )

    @cached_property
    def _motion(self) -> str:
        try:
            return source_text(self.program, LANGUAGES["c"])
        except Unwritten as unwritten:
            what = _("the operation {operation} has no words in {language}")
            text = what.format(operation=unwritten.operation, language="C")
            raise NotComputedYet("--format fmu", text) from None

    @property
    def start(self) -> float:
        """Value of the drive at the beginning."""
        simulation = self.program.mechanism.simulation
        if self.dynamic and simulation is not None and simulation.start is not None:
            return float(simulation.start)
        return float(self.program.numbers["initial"])

    @property
    def speed(self) -> float:
        """Speed of the drive at the beginning: that of the simulation, along the drive's coordinate."""
        simulation = self.program.mechanism.simulation
        if not self.dynamic:
            return self.program.speed
        speed = 0.0 if simulation is None else simulation.speed or 0.0
        return speed * float(self.program.numbers["forward"])

    @cached_property
    def token(self) -> str:
        """What tells this model from others."""
        told = self._motion + repr((self.outputs, self.dynamic, self.shaft_inertia, self.start, self.speed))
        return hashlib.blake2b(told.encode(), digest_size=16).hexdigest()

    @property
    def title(self) -> str:
        """Name of the model for people."""
        return self.program.mechanism.title or ""

    @property
    def variables(self) -> tuple[FmuVariable, ...]:
        """All variables but time."""
        program = self.program
        unit = program.drive_unit
        rates = (unit, f"{unit}/s", f"{unit}/s^2")
        if self.dynamic:
            word, effort = ("drive moment", "N m") if unit == "rad" else ("drive force", "N")
            moving = [
                input_variable(word, FIRST_INPUT, effort),
                state_variable("drive", 0, rates[0], self.start),
                state_variable("drive speed", 1, rates[1], self.speed),
                derivative_variable("der(drive)", 0, rates[1]),
                derivative_variable("der(drive speed)", 1, rates[2]),
            ]
        else:
            given = (("drive", self.start), ("drive speed", self.speed), ("drive acceleration", 0.0))
            moving = [
                input_variable(name, FIRST_INPUT + k, rates[k], start)
                for k, (name, start) in enumerate(given)
            ]
        fixed = {"causality": "parameter", "variability": "fixed", "initial": "exact"}
        dimensions = [
            FmuVariable(path, FIRST_DIMENSION + k, "", {"start": repr(value)} | fixed)
            for k, (path, value) in enumerate(zip(program.paths, program.values, strict=True))
        ]
        results = (program.results[row] for row in self.outputs)
        given_out = [output_variable(result.name, k, result.unit) for k, result in enumerate(results)]
        return (*moving, *dimensions, STATUS, *given_out)

    def archive(self, binaries: Mapping[str, bytes] | None = None) -> bytes:
        """The FMU, with binaries by their places ("binaries/x86_64-linux/NAME.so")."""
        return archive_of(self, binaries)


def fmu_program(
    source: MechanismSource,
    vary: Sequence[str] | None = None,
    outputs: Sequence[str] | None = None,
    *,
    driven: bool = False,
    name: str | None = None,
    start: End = None,
    stop: End = None,
) -> Fmu:
    """A mechanism as an FMU of FMI 3.0, for co-simulation and model exchange.

    Where `ct.simulate` takes the equations of all links, they are printed, with a moment or force for every drive;
    else the motion of the one drive is.

    Parameters
    ----------
    source : Mechanism, file or name of an example
    vary : paths of dimensions that are parameters; all lengths and the places of fixed points by default
    outputs : names of results ("position B x", "angle AB"); all of them by default
    driven : the drive's value, speed and acceleration are inputs; otherwise its moment is one, and it moves freely
    name : identifier of the model
    start, stop : range of the drive [rad or m]; by default that of the description, of an angle a turn, over which
        whole turns repeat, and half a turn back (with gears, whose turns are counted, four turns and one back)

    Raises
    ------
    NotComputedYet
        What `motion_code` refuses, several drives, masses and loads that are not reduced: each by its name.
    InputError
        An output that is none, and what `motion_code` refuses.

    Examples
    --------
    >>> from centrode.export.fmi import fmu_program
    >>> fmu = fmu_program("single-cylinder-engine", [], ["position B x"])
    >>> len(fmu.archive()) > 5000
    True
    """
    mechanism = mechanism_of(source)
    label = name or (source if isinstance(source, str) else None)
    settings = mechanism.simulation or Simulation()
    if not driven and has_masses_or_loads(mechanism) and equations_for(mechanism, settings) == MULTIBODY:
        _refuse_what_belongs_to_one_drive(vary, start, stop)
        return free_fmu(mechanism, settings, outputs, label)
    prepared = ready(mechanism)
    path = prepared.kinematics.path
    if path.by_time:
        what = _("an FMU has one drive, and the mechanism has {count}").format(count=len(mechanism.drives))
        raise NotComputedYet(
            "--format fmu", what, _("simulate it by: {command}").format(command="centrode simulate")
        )
    if path.turns and start is None and stop is None:
        # a turn repeats; what swings goes back from its beginning; turns of gears are counted, and do not repeat
        back, onwards = (1.0, 4.0) if mechanism.gears or mechanism.rolling else (0.5, 1.0)
        start, stop = path.initial - back * 2.0 * pi, path.initial + onwards * 2.0 * pi
    # loads see the speed that the drive has, not the mean speed of a machine; what turns with the drive stays
    inertia = 0.0 if mechanism.machine is None or driven else mechanism.machine.inertia
    mechanism = mechanism if driven else mechanism.model_copy(update={"machine": None})
    program = traced_program(mechanism, vary, name=label, start=start, stop=stop, option="--format fmu")
    if not driven:
        _check_dynamics(program)
    chosen = chosen_outputs([result.name for result in program.results], outputs)
    return FmuProgram(replace(program, is_dynamic=not driven), chosen, not driven, inertia)


COMPILERS = ("cc", "gcc", "clang")
PLATFORMS = {
    ("linux", "x86_64"): ("x86_64-linux", ".so"), ("linux", "aarch64"): ("aarch64-linux", ".so"),
    ("darwin", "x86_64"): ("x86_64-darwin", ".dylib"), ("darwin", "arm64"): ("aarch64-darwin", ".dylib"),
}  # fmt: skip
"""System and processor -> folder of binaries in an FMU, and their ending."""


def fmu_binaries(fmu: Fmu) -> dict[str, bytes]:
    """A binary for this machine by its place in the archive, made by its C compiler.

    Raises InputError where there is no compiler, and where the machine is of another kind.
    """
    compiler = next((path for path in map(shutil.which, COMPILERS) if path), None)
    place = PLATFORMS.get((sys.platform, platform.machine()))
    if compiler is None or place is None:
        what = _("there is no C compiler for a binary of this machine")
        raise InputError("--compile", what, _("omit --compile: importers compile the source"))
    folder_name, ending = place
    with tempfile.TemporaryDirectory(prefix="centrode-") as folder:
        source, library = Path(folder) / f"{fmu.name}.c", Path(folder) / f"{fmu.name}{ending}"
        source.write_text(fmu.source, encoding="utf-8")
        words = [compiler, "-std=c99", "-O2", "-shared", "-fPIC", "-o", str(library), str(source), "-lm"]
        ended = subprocess.run(words, capture_output=True, text=True, check=False)
        if ended.returncode:
            what = _("the C compiler {compiler} ended with {code}").format(
                compiler=compiler, code=ended.returncode
            )
            raise InputError("--compile", what, _("omit --compile: importers compile the source"))
        return {f"binaries/{folder_name}/{library.name}": library.read_bytes()}


def _check_dynamics(program: MotionProgram) -> None:
    names = {quantity.name for quantity in program.traced.quantities}
    if "reduced_inertia" in names:
        return
    reason = program.traced.missing or _("it has no masses")
    what = _("masses and loads are not reduced to the drive: {reason}").format(reason=reason)
    raise NotComputedYet("--format fmu", what, _("give links masses, or add --driven"))


def _refuse_what_belongs_to_one_drive(vary: Sequence[str] | None, start: End, stop: End) -> None:
    for option, value in (("--vary", vary or None), ("--from", start), ("--to", stop)):
        if value is not None:
            what = _("the equations of all links are printed with the numbers of the description")
            raise NotComputedYet(option, what, _("remove it"))
