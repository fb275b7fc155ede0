"""A mechanism with one drive as a unit of co-simulation and model exchange (FMI 3.0), as C source.

The forward dynamics is the reduced equation J q'' + J' q'^2 / 2 = M + M_drive, whose J, J' and M are printed from the
graph of the reduction; the driven motion is a function of the drive's value, speed and acceleration.
"""

from __future__ import annotations

import hashlib
import io
import platform
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from importlib.resources import files
from math import pi
from pathlib import Path
from typing import TypeAlias
from xml.etree import ElementTree as ET

from centrode.errors import InputError, NotComputedYet
from centrode.export.code_files import source_text
from centrode.export.motion_program import CodeResult, MotionProgram, traced_program
from centrode.kinematics.preparation import ready
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.numerics.graphs import Unwritten
from centrode.numerics.source_languages import LANGUAGES
from centrode.version import __version__

End: TypeAlias = float | str | None

FIRST_DIMENSION, FIRST_OUTPUT = 100, 1000
STATUS_REFERENCE, TOLERANCE_REFERENCE = 10, 11
ANGLES = ("angle", "joint_angle", "hinge_angle")
PLATFORM_MARK = (1980, 1, 1, 0, 0, 0)
"""Date of the files in the archive: the same mechanism gives the same bytes."""


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
        defines: Mapping[str, str] = {
            "MODEL": name, "PREPARE": f"{name}_prepare", "AT": f"{name}_at", "MODEL_DIMENSIONS": f"{name}_dimensions",
            "OUTPUTS": str(len(results)), "PARAMETERS": str(len(program.paths)), "DYNAMIC": str(int(self.dynamic)),
            "WRAPS": str(int(wraps)), "PERIOD": known(2.0 * pi)[0], "START_PLACE": known(self.start)[0],
            "FIRST_PLACE": known(float(program.numbers["initial"]))[0], "START_SPEED": known(self.speed)[0],
            "SHAFT_INERTIA": known(self.shaft_inertia)[0], "TOKEN": f'"{self.token}"',
        }  # fmt: skip
        rows = ", ".join(str(k) for k in self.outputs) or "0"
        turned = ", ".join(str(int(x.quantity in ANGLES)) for x in results) or "0"
        engine = files("centrode.export").joinpath("fmi3.c").read_text(encoding="utf-8")
        if not self.dynamic:
            engine = engine.replace("    evaluate_reduced(&c->model);\n", "")
        return "\n".join(
            [
                self._motion,
                *(f"#define {word} {text}" for word, text in defines.items()),
                f"static const int output_rows[] = {{{rows}}};",
                f"static const int output_turns[] = {{{turned}}};",
                engine,
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
    def description(self) -> str:
        """`modelDescription.xml`."""
        program = self.program
        unit = program.drive_unit
        root = ET.Element(
            "fmiModelDescription",
            fmiVersion="3.0", modelName=program.mechanism.title or self.name, instantiationToken=self.token,
            generationTool=f"centrode {__version__}", variableNamingConvention="flat",
        )  # fmt: skip
        ET.SubElement(root, "ModelExchange", modelIdentifier=self.name, canGetAndSetFMUState="true")
        ET.SubElement(root, "CoSimulation", modelIdentifier=self.name, canGetAndSetFMUState="true",
                      canHandleVariableCommunicationStepSize="true")  # fmt: skip
        units = ET.SubElement(root, "UnitDefinitions")
        ET.SubElement(
            root, "DefaultExperiment", startTime="0", stopTime="1", tolerance="1e-9", stepSize="0.01"
        )
        variables = ET.SubElement(root, "ModelVariables")
        used: dict[str, None] = {}

        def add(kind: str, name: str, reference: int, unit: str = "", **attributes: str) -> None:
            more = dict(attributes)
            if unit and unit != "1":
                used[unit] = None
                more["unit"] = unit
            ET.SubElement(
                variables, kind, {"name": _plain_name(name), "valueReference": str(reference), **more}
            )

        add("Float64", "time", 0, "s", causality="independent", variability="continuous")
        rates = (unit, f"{unit}/s", f"{unit}/s^2")
        entering = {"causality": "input", "variability": "continuous"}
        if self.dynamic:
            effort = "N m" if unit == "rad" else "N"
            add(
                "Float64",
                "drive moment" if unit == "rad" else "drive force",
                1,
                effort,
                start="0",
                **entering,
            )
            leaving = {"causality": "output", "variability": "continuous", "initial": "exact"}
            add("Float64", "drive", 4, rates[0], start=repr(self.start), **leaving)
            add("Float64", "drive speed", 5, rates[1], start=repr(self.speed), **leaving)
            local = {"causality": "local", "variability": "continuous", "initial": "calculated"}
            add("Float64", "der(drive)", 6, rates[1], derivative="4", **local)
            add("Float64", "der(drive speed)", 7, rates[2], derivative="5", **local)
        else:
            for k, (name, start) in enumerate(
                (("drive", self.start), ("drive speed", self.speed), ("drive acceleration", 0.0))
            ):
                add("Float64", name, 1 + k, rates[k], start=repr(start), **entering)
        for k, (path, value) in enumerate(zip(program.paths, program.values, strict=True)):
            add("Float64", path, FIRST_DIMENSION + k, start=repr(value), causality="parameter", variability="fixed",
                initial="exact")  # fmt: skip
        calculated = {"causality": "output", "initial": "calculated"}
        add("Int32", "status", STATUS_REFERENCE, variability="discrete", **calculated)
        for k, row in enumerate(self.outputs):
            result = program.results[row]
            add("Float64", result.name, FIRST_OUTPUT + k, result.unit, variability="continuous", **calculated)
        for name in used:
            _add_unit(units, name)
        self._add_structure(root)
        ET.indent(root)
        return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"

    def _add_structure(self, root: ET.Element) -> None:
        structure = ET.SubElement(root, "ModelStructure")
        calculated = [STATUS_REFERENCE, *(FIRST_OUTPUT + k for k in range(len(self.outputs)))]
        states, derivatives = ([4, 5], [6, 7]) if self.dynamic else ([], [])
        for reference in [*states, *calculated]:
            ET.SubElement(structure, "Output", valueReference=str(reference))
        for reference in derivatives:
            ET.SubElement(structure, "ContinuousStateDerivative", valueReference=str(reference))
        for reference in [*calculated, *derivatives]:
            ET.SubElement(structure, "InitialUnknown", valueReference=str(reference))

    @property
    def build_description(self) -> str:
        """`sources/buildDescription.xml`: how importers compile the source."""
        root = ET.Element("fmiBuildDescription", fmiVersion="3.0")
        build = ET.SubElement(root, "BuildConfiguration", modelIdentifier=self.name)
        sources = ET.SubElement(build, "SourceFileSet", language="C99")
        ET.SubElement(sources, "SourceFile", name=f"{self.name}.c")
        ET.indent(root)
        return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"

    def archive(self, binaries: Mapping[str, bytes] | None = None) -> bytes:
        """The FMU: descriptions, source, and binaries by their places ("binaries/x86_64-linux/NAME.so")."""
        held: dict[str, bytes] = {
            "modelDescription.xml": self.description.encode(),
            "sources/buildDescription.xml": self.build_description.encode(),
            f"sources/{self.name}.c": self.source.encode(),
            **(binaries or {}),
        }
        stream = io.BytesIO()
        with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, content in held.items():
                archive.writestr(zipfile.ZipInfo(name, PLATFORM_MARK), content, zipfile.ZIP_DEFLATED)
        return stream.getvalue()


def fmu_program(
    source: MechanismSource,
    vary: Sequence[str] | None = None,
    outputs: Sequence[str] | None = None,
    *,
    driven: bool = False,
    name: str | None = None,
    start: End = None,
    stop: End = None,
) -> FmuProgram:
    """A mechanism with one drive as an FMU of FMI 3.0, for co-simulation and model exchange.

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
    label = name or (source if isinstance(source, str) else None)
    # loads see the speed that the drive has, not the mean speed of a machine; what turns with the drive stays
    inertia = 0.0 if mechanism.machine is None or driven else mechanism.machine.inertia
    mechanism = mechanism if driven else mechanism.model_copy(update={"machine": None})
    program = traced_program(mechanism, vary, name=label, start=start, stop=stop, option="--format fmu")
    if not driven:
        _check_dynamics(program)
    chosen = _chosen_outputs(program.results, outputs)
    return FmuProgram(replace(program, is_dynamic=not driven), chosen, not driven, inertia)


COMPILERS = ("cc", "gcc", "clang")
PLATFORMS = {
    ("linux", "x86_64"): ("x86_64-linux", ".so"), ("linux", "aarch64"): ("aarch64-linux", ".so"),
    ("darwin", "x86_64"): ("x86_64-darwin", ".dylib"), ("darwin", "arm64"): ("aarch64-darwin", ".dylib"),
}  # fmt: skip
"""System and processor -> folder of binaries in an FMU, and their ending."""


def fmu_binaries(fmu: FmuProgram) -> dict[str, bytes]:
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


def _chosen_outputs(results: Sequence[CodeResult], outputs: Sequence[str] | None) -> tuple[int, ...]:
    names = [result.name for result in results]
    if outputs is None:
        return tuple(range(len(names)))
    for output in outputs:
        if output not in names:
            some = ", ".join(names[:4])
            what = _("there is no output {output}").format(output=output)
            raise InputError("--output", what, _("use one of: {names} ...").format(names=some))
    return tuple(names.index(output) for output in dict.fromkeys(outputs))


def _plain_name(name: str) -> str:
    """A name without what formats of variables do not take: control characters."""
    return "".join(c if c.isprintable() else " " for c in name)


def _add_unit(units: ET.Element, name: str) -> None:
    """A unit by its powers of base units."""
    powers: dict[str, int] = {}
    for k, part in enumerate(name.split("/")):
        for word in part.split():
            found = re.fullmatch(r"([A-Za-z]+)(?:\^(\d))?", word)
            if found is None:
                continue
            sign = -1 if k else 1
            for base, power in _BASES.get(found[1], {found[1]: 1}).items():
                powers[base] = powers.get(base, 0) + sign * power * int(found[2] or 1)
    unit = ET.SubElement(units, "Unit", name=name)
    ET.SubElement(unit, "BaseUnit", {base: str(power) for base, power in powers.items()})


_BASES: Mapping[str, Mapping[str, int]] = {"N": {"kg": 1, "m": 1, "s": -2}}
