"""A mechanism by the equations of all its links as an FMU: several degrees of freedom, an effort for each drive.

States are the joint coordinates of `ct.simulate` and their speeds; the accelerations, the closing of the loops behind a
step and the outputs are printed from the graphs of the equations of motion.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, TypeAlias

from centrode.dynamics.forward_dynamics.equations_of_motion import EquationsOfMotion
from centrode.dynamics.forward_dynamics.free_loads import DriveEffort, free_loads_of
from centrode.dynamics.forward_dynamics.initial_state import InitialState
from centrode.dynamics.forward_dynamics.joint_state import JointState
from centrode.dynamics.forward_dynamics.motion_problem import MotionNames, turned_rotor
from centrode.dynamics.forward_dynamics.spanning_tree import JointValues
from centrode.dynamics.simulation.multibody_motion import coordinate_names, multibody_setting
from centrode.errors import NotComputedYet
from centrode.export.fmi_archive import (
    FIRST_INPUT,
    STATUS,
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
from centrode.export.motion_program import program_name
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.simulation import Simulation
from centrode.numerics.expressions import EXPRESSIONS, Node, as_node, variable
from centrode.numerics.graphs import Unwritten
from centrode.numerics.initial_value_problems import TIME
from centrode.numerics.jets import Jet
from centrode.numerics.source_languages import LANGUAGES, RecordFunction
from centrode.quantities import QUANTITIES

Number: TypeAlias = Any

PLACES = ("position", "velocity", "acceleration")
TURNS = ("angle", "angular_velocity", "angular_acceleration")
SLIDES = ("slide", "slide_velocity", "slide_acceleration")


@dataclass(frozen=True)
class LinksFmu:
    """A mechanism of several degrees of freedom as an FMU.

    Attributes
    ----------
    mechanism : the description
    equations : of its motion, moments and forces of the drives among the loads
    coordinates : names of the joint coordinates
    start : of all of them
    name : identifier of the model
    chosen : places of the outputs among all
    """

    mechanism: Mechanism
    equations: EquationsOfMotion
    coordinates: tuple[str, ...]
    start: InitialState
    name: str
    chosen: tuple[int, ...] = ()

    @property
    def title(self) -> str:
        """Name of the model for people."""
        return self.mechanism.title or ""

    # Graphs.

    @cached_property
    def _names(self) -> MotionNames:
        return MotionNames.of(self.equations)

    @cached_property
    def _values(self) -> JointValues:
        return self.equations.tree.values(EXPRESSIONS, [variable(x) for x in self._names.coordinates])

    @cached_property
    def _speeds(self) -> list[Node]:
        return [variable(x) for x in self._names.speeds]

    @cached_property
    def _accelerations(self) -> list[Number]:
        terms = self.equations.terms(EXPRESSIONS, self._values, self._speeds, variable(TIME))
        return self.equations.accelerations(EXPRESSIONS, terms)[0]

    @cached_property
    def _closing(self) -> list[Number]:
        """Closed coordinates, speeds that fit them, and how independent the closures are."""
        m, equations, values, time = EXPRESSIONS, self.equations, self._values, variable(TIME)
        if not equations.equations:
            return [*values.coordinates, *self._speeds, 1.0]
        terms = equations.terms(m, values, self._speeds, time)
        system = equations.system(m, terms)
        shift = equations.shift_to_close(terms, system)
        q = [x + shift.get(k, 0.0) for k, x in enumerate(values.coordinates)]
        rotors = {k: turned_rotor(values.rotors[k], shift.get(k, 0.0)) for k in equations.tree.angles}
        w = equations.consistent_speeds(m, JointValues(q, rotors), self._speeds, time, system)
        return [*q, *w, system.independence(m)]

    @cached_property
    def known_outputs(self) -> dict[str, tuple[str, Number]]:
        """Unit and number of every output by its name."""
        values = self._values
        jets = [
            Jet((q, w, 0.5 * a))
            for q, w, a in zip(values.coordinates, self._speeds, self._accelerations, strict=True)
        ]
        at = self.equations.state(EXPRESSIONS, values, jets, variable(TIME))
        found: dict[str, tuple[str, Number]] = {}

        def add(kinds: Sequence[str], of: str, jet: Jet) -> None:
            for order, kind in enumerate(kinds):
                known = QUANTITIES[kind].for_drive("s")
                unit = (known.on_sphere() if self.mechanism.space == "sphere" else known).unit
                found[f"{kind.replace('_', ' ')} {of}"] = (unit, jet.derivative(order))

        for point in self.mechanism.moving_points:
            for axis, jet in zip("xyz", at.point(point), strict=False):
                add(PLACES, f"{point} {axis}", jet)
        for link in self.mechanism.links:
            if link in at.at.angles:
                add(TURNS, link, at.angle(link))
        for guide in self.mechanism.guides:
            add(SLIDES, guide.id, at.slide(guide.id))
        found |= self._of_drives(at)
        found["kinetic energy"] = ("J", self.equations.kinetic_energy(at))
        return found

    def _of_drives(self, at: JointState) -> dict[str, tuple[str, Number]]:
        found = {}
        for drive, one in zip(self.mechanism.drives, self.mechanism.motion_parameter.drives, strict=True):
            jet = at.drive(drive)
            found[f"drive {drive.id}"] = (one.unit, one.value_of(jet.coefficients[0]))
            found[f"drive speed {drive.id}"] = (f"{one.unit}/s", one.sense * jet.coefficients[1])
        return found

    @cached_property
    def outputs(self) -> dict[str, tuple[str, Number]]:
        """Unit and number of every output that is given, by its name."""
        rows = list(self.known_outputs.items())
        return dict(rows[k] for k in self.chosen)

    # The printed program.

    @cached_property
    def functions(self) -> tuple[RecordFunction, ...]:
        """The functions of the record."""
        names = self._names
        variables: dict[str, tuple[str, int | None]] = {TIME: ("time", None)}
        variables |= {name: ("coordinate", k) for k, name in enumerate(names.coordinates)}
        variables |= {name: ("speed", k) for k, name in enumerate(names.speeds)}
        variables |= {_input(k): ("input", k) for k in range(len(self.mechanism.drives))}

        def function(name: str, array: str, numbers: Sequence[Number]) -> RecordFunction:
            return RecordFunction(name, array, variables, [as_node(x) for x in numbers])

        return (
            function("evaluate_accelerations", "acceleration", self._accelerations),
            function("evaluate_closing", "closed", self._closing),
            function("evaluate_outputs", "row", [number for _unit, number in self.outputs.values()]),
        )

    @cached_property
    def _motion(self) -> str:
        language, count = LANGUAGES["c"], self.equations.size
        sizes = {
            "coordinate": count, "speed": count, "acceleration": count, "closed": 2 * count + 1,
            "input": max(1, len(self.mechanism.drives)), "row": max(1, len(self.outputs)),
        }  # fmt: skip
        try:
            formulas = [line for one in self.functions for line in one.lines(language)]
        except Unwritten as unwritten:
            what = _("the operation {operation} has no words in {language}")
            text = what.format(operation=unwritten.operation, language="C")
            raise NotComputedYet("--format fmu", text) from None
        slid = ", ".join(str(int(one.kind != "angle")) for one in self.equations.tree.coordinates)
        return "\n".join(
            [
                "#include <math.h>",
                "",
                "typedef struct {",
                *(f"    double {array}[{size}];" for array, size in sizes.items()),
                "    double time;",
                "} record;",
                "",
                *language.helpers.splitlines(),
                "",
                *formulas,
                f"static const int coordinate_is_length[] = {{{slid}}};",
            ]
        )

    @cached_property
    def source(self) -> str:
        """One C file with everything."""
        count = self.equations.size
        defines = {
            "OUTPUTS": str(len(self.outputs)), "PARAMETERS": "0", "INPUTS": str(len(self.mechanism.drives)),
            "COORDINATES": str(count), "STATES": str(2 * count),
            "START_INPUTS": numbers_text([0.0] * len(self.mechanism.drives)),
            "START_STATES": numbers_text(self._start_states),
            "LENGTH": LANGUAGES["c"].notation.number(float(self.equations.numbers.scale))[0],
            "TOKEN": f'"{self.token}"',
        }  # fmt: skip
        lines = [f"#define {word} {text}" for word, text in defines.items()]
        dimensions = "static const double MODEL_DIMENSIONS[] = {0.0};"
        return "\n".join([self._motion, *lines, dimensions, engine("fmi3_links.c")])

    @property
    def _start_states(self) -> list[float]:
        return [float(x) for x in (*self.start.coordinates, *self.start.speeds)]

    @cached_property
    def token(self) -> str:
        """What tells this model from others."""
        told = self._motion + repr((list(self.outputs), self._start_states))
        return hashlib.blake2b(told.encode(), digest_size=16).hexdigest()

    @property
    def variables(self) -> tuple[FmuVariable, ...]:
        """All variables but time."""
        found: list[FmuVariable] = []
        for k, one in enumerate(self.mechanism.motion_parameter.drives):
            word, unit = ("moment", "N m") if one.unit == "rad" else ("force", "N")
            found.append(input_variable(f"drive {word} {one.name}", FIRST_INPUT + k, unit))
        count, units = self.equations.size, [one.unit for one in self.equations.tree.coordinates]
        told = [
            *((f"coordinate {name}", unit) for name, unit in zip(self.coordinates, units, strict=True)),
            *((f"speed {name}", f"{unit}/s") for name, unit in zip(self.coordinates, units, strict=True)),
        ]
        for k, ((name, unit), start) in enumerate(zip(told, self._start_states, strict=True)):
            found.append(state_variable(name, k, unit, start, "local"))
        for k, (name, _unit) in enumerate(told):
            found.append(
                derivative_variable(f"der({name})", k, f"{units[k % count]}/s{'^2' if k >= count else ''}")
            )
        rows = enumerate(self.outputs.items())
        return (*found, STATUS, *(output_variable(name, k, unit) for k, (name, (unit, _number)) in rows))

    def archive(self, binaries: Mapping[str, bytes] | None = None) -> bytes:
        """The FMU, with binaries by their places ("binaries/x86_64-linux/NAME.so")."""
        return archive_of(self, binaries)


def _given_effort(effort: Node, _algebra: Any, _time: Any, _value: Any, _speed: Any) -> Any:
    """The law of an effort that an input gives: whatever time, value and speed are."""
    return effort


def _input(number: int) -> str:
    return f"input {number}"


def free_fmu(
    mechanism: Mechanism, settings: Simulation, outputs: Sequence[str] | None, label: str | None
) -> LinksFmu:
    """The FMU of a mechanism by the equations of all links.

    Raises
    ------
    NotComputedYet
        Stops, clamps, dry friction, events, controllers and drives that keep their laws.
    InputError
        An output that is none, and what `ct.simulate` refuses.
    """
    if settings.keeps:
        what = _("drives that keep their laws are not in an FMU: {names}").format(
            names=", ".join(settings.keeps)
        )
        raise NotComputedYet("[simulation] keeps", what, _("leave all drives free, or add --driven"))
    # what drives is left to the inputs
    free = settings.model_copy(update={"driving": None, "motor": None})
    setting = multibody_setting(mechanism, free)
    motion = setting.free
    equations = motion.equations
    named = [contact.label for contact in equations.contacts]
    named += [condition.label for condition in equations.conditions]
    named += [control.label for control in equations.controls]
    if named:
        what = _("stops, clamps, dry friction, events and controllers are not in an FMU: {names}")
        repair = _("remove them, or simulate it by: {command}").format(command="centrode simulate")
        raise NotComputedYet("--format fmu", what.format(names=", ".join(named)), repair)
    efforts = []
    for number, driven in enumerate(mechanism.motion_parameter.drives):
        node = driven.sense * variable(_input(number))
        efforts.append(DriveEffort(driven.name, partial(_given_effort, node), frozenset()))
    fmu = LinksFmu(
        mechanism,
        replace(equations, loads=(*equations.loads, *free_loads_of(mechanism, (), efforts))),
        coordinate_names(motion),
        motion.initial(setting.speeds, setting.start),
        program_name(label or mechanism.title or ""),
    )
    chosen = chosen_outputs(list(fmu.known_outputs), outputs)
    return replace(fmu, chosen=chosen)
