"""A model as an archive of FMI 3.0: its variables and its structure described, and its C source."""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from importlib.resources import files
from typing import Protocol
from xml.etree import ElementTree as ET

from centrode.errors import InputError
from centrode.locale import _
from centrode.numerics.source_languages import LANGUAGES
from centrode.version import __version__

FIRST_INPUT, STATUS_REFERENCE = 1, 10
FIRST_DIMENSION, FIRST_OUTPUT, FIRST_STATE, FIRST_DERIVATIVE = 100, 1000, 100_000, 200_000
"""References of variables, as `fmi3.c` has them."""
PLATFORM_MARK = (1980, 1, 1, 0, 0, 0)
"""Date of the files in the archive: the same mechanism gives the same bytes."""


@dataclass(frozen=True)
class FmuVariable:
    """A number of an FMU: its name, reference, unit and the attributes that FMI asks for."""

    name: str
    reference: int
    unit: str = ""
    attributes: Mapping[str, str] = field(default_factory=dict)
    kind: str = "Float64"


def input_variable(name: str, reference: int, unit: str, start: float = 0.0) -> FmuVariable:
    """An input."""
    return FmuVariable(
        name, reference, unit, {"causality": "input", "variability": "continuous", "start": repr(start)}
    )


def state_variable(name: str, number: int, unit: str, start: float, causality: str = "output") -> FmuVariable:
    """A continuous state."""
    told = {"causality": causality, "variability": "continuous", "initial": "exact", "start": repr(start)}
    return FmuVariable(name, FIRST_STATE + number, unit, told)


def derivative_variable(name: str, number: int, unit: str) -> FmuVariable:
    """The derivative of a state."""
    told = {"causality": "local", "variability": "continuous", "initial": "calculated"}
    return FmuVariable(
        name, FIRST_DERIVATIVE + number, unit, {"derivative": str(FIRST_STATE + number)} | told
    )


def output_variable(name: str, number: int, unit: str) -> FmuVariable:
    """An output."""
    told = {"causality": "output", "variability": "continuous", "initial": "calculated"}
    return FmuVariable(name, FIRST_OUTPUT + number, unit, told)


STATUS = FmuVariable(
    "status",
    STATUS_REFERENCE,
    "",
    {"causality": "output", "variability": "discrete", "initial": "calculated"},
    "Int32",
)


class Fmu(Protocol):
    """What an archive is made of."""

    @property
    def name(self) -> str:
        """Identifier of the model."""

    @property
    def title(self) -> str:
        """Name of the model for people."""

    @property
    def token(self) -> str:
        """What tells this model from others."""

    @property
    def source(self) -> str:
        """One C file with everything."""

    @property
    def variables(self) -> Sequence[FmuVariable]:
        """All variables but time; states before their derivatives."""

    def archive(self, binaries: Mapping[str, bytes] | None = None) -> bytes:
        """The FMU."""


def engine(part: str) -> str:
    """What stands around a model in C: its part of "fmi3_drive.c" or "fmi3_links.c", then the functions of FMI."""
    room = files("centrode.export")
    return "\n".join(room.joinpath(name).read_text(encoding="utf-8") for name in (part, "fmi3.c"))


def archive_of(fmu: Fmu, binaries: Mapping[str, bytes] | None = None) -> bytes:
    """The FMU: descriptions, source, and binaries by their places ("binaries/x86_64-linux/NAME.so")."""
    held: dict[str, bytes] = {
        "modelDescription.xml": description(fmu).encode(),
        "sources/buildDescription.xml": _build_description(fmu).encode(),
        f"sources/{fmu.name}.c": fmu.source.encode(),
        **(binaries or {}),
    }
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in held.items():
            archive.writestr(zipfile.ZipInfo(name, PLATFORM_MARK), content, zipfile.ZIP_DEFLATED)
    return stream.getvalue()


def description(fmu: Fmu) -> str:
    """`modelDescription.xml`."""
    root = ET.Element(
        "fmiModelDescription",
        fmiVersion="3.0", modelName=fmu.title or fmu.name, instantiationToken=fmu.token,
        generationTool=f"centrode {__version__}", variableNamingConvention="flat",
    )  # fmt: skip
    ET.SubElement(root, "ModelExchange", modelIdentifier=fmu.name, canGetAndSetFMUState="true")
    ET.SubElement(root, "CoSimulation", modelIdentifier=fmu.name, canGetAndSetFMUState="true",
                  canHandleVariableCommunicationStepSize="true")  # fmt: skip
    units = ET.SubElement(root, "UnitDefinitions")
    ET.SubElement(root, "DefaultExperiment", startTime="0", stopTime="1", tolerance="1e-9", stepSize="0.01")
    listed = ET.SubElement(root, "ModelVariables")
    time = FmuVariable("time", 0, "s", {"causality": "independent", "variability": "continuous"})
    used: dict[str, None] = {}
    for one in (time, *fmu.variables):
        told = {"name": _plain_name(one.name), "valueReference": str(one.reference), **one.attributes}
        if one.unit and one.unit != "1":
            used[one.unit] = None
            told["unit"] = one.unit
        ET.SubElement(listed, one.kind, told)
    for name in used:
        _add_unit(units, name)
    _add_structure(root, fmu.variables)
    return _text_of(root)


def _add_structure(root: ET.Element, variables: Sequence[FmuVariable]) -> None:
    structure = ET.SubElement(root, "ModelStructure")
    outputs = [one for one in variables if one.attributes["causality"] == "output"]
    derivatives = [one for one in variables if "derivative" in one.attributes]
    calculated = [one for one in outputs if one.attributes["initial"] == "calculated"]
    listed = {
        "Output": outputs,
        "ContinuousStateDerivative": derivatives,
        "InitialUnknown": [*calculated, *derivatives],
    }
    for word, group in listed.items():
        for one in group:
            ET.SubElement(structure, word, valueReference=str(one.reference))


def _build_description(fmu: Fmu) -> str:
    """`sources/buildDescription.xml`: how importers compile the source."""
    root = ET.Element("fmiBuildDescription", fmiVersion="3.0")
    build = ET.SubElement(root, "BuildConfiguration", modelIdentifier=fmu.name)
    sources = ET.SubElement(build, "SourceFileSet", language="C99")
    ET.SubElement(sources, "SourceFile", name=f"{fmu.name}.c")
    return _text_of(root)


def _text_of(root: ET.Element) -> str:
    ET.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def numbers_text(numbers: Sequence[float]) -> str:
    """Numbers that an array of C begins with; of no numbers one zero, as C knows no empty array."""
    known = LANGUAGES["c"].notation.number
    return "{" + (", ".join(known(float(x))[0] for x in numbers) or "0.0") + "}"


def chosen_outputs(names: Sequence[str], outputs: Sequence[str] | None) -> tuple[int, ...]:
    """Places of outputs among all that there are; all of them if none are named. Raises InputError."""
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


_BASES: Mapping[str, Mapping[str, int]] = {
    "N": {"kg": 1, "m": 1, "s": -2},
    "J": {"kg": 1, "m": 2, "s": -2},
}
