"""A mechanism for other programs: models of robots and simulators, a macro of a drawing program, source files."""

from __future__ import annotations

from centrode.dynamics.masses import has_masses_or_loads
from centrode.kinematics.motion import initial_place, motion
from centrode.locale import mark
from centrode.model.mechanism import Mechanism
from centrode.topics.topic import Lazily

MJCF = Lazily("centrode.export.mjcf", "mjcf_text")
ROBOTS = {
    "urdf": Lazily("centrode.export.robot_models", "urdf_model"),
    "sdf": Lazily("centrode.export.robot_models", "sdf_model"),
}
FMU = Lazily("centrode.export.fmi", "fmu_program")
FREECAD = Lazily("centrode.export.freecad", "freecad_macro")
CODE = Lazily("centrode.export.motion_code", "motion_code")
NAME = Lazily("centrode.export.motion_program", "program_name")
CODE_ENDINGS = {"c": "c", "python": "py", "matlab": "m", "javascript": "js"}
"""Language of a source file -> its ending."""
MODELS = {
    "model": (mark("Model for MuJoCo"), ("xml",)),
    "robot": (mark("Model for ROS and Gazebo"), tuple(ROBOTS)),
    "fmu": (mark("Model for Simulink and others"), ("fmu",)),
    "freecad": (mark("Macro for FreeCAD"), ("FCMacro",)),
    "code": (mark("Motion as a source file"), tuple(CODE_ENDINGS)),
}
"""What is written for other programs, and the formats of each."""


def model_files(mechanism: Mechanism, kind: str, stem: str) -> dict[str, bytes]:
    """Files of a mechanism in a format of `MODELS`: name -> content; raises CentrodeError where there are none."""
    if kind in ROBOTS:
        model = ROBOTS[kind](mechanism)
        return {f"{stem}.{kind}": model.text.encode(), f"{stem}.loops.json": model.loops.encode()}
    if kind == "fmu":
        # without masses and loads nothing moves it but its drive
        program = FMU(mechanism, name=NAME(stem), driven=not has_masses_or_loads(mechanism))
        return {f"{NAME(stem)}.fmu": program.archive()}
    if kind in CODE_ENDINGS:
        # called as its file: MATLAB finds functions so
        return {f"{NAME(stem)}.{CODE_ENDINGS[kind]}": CODE(mechanism, kind, name=NAME(stem)).encode()}
    if kind == "FCMacro":
        return {f"{stem}.FCMacro": FREECAD(mechanism).encode()}
    return {f"{stem}.xml": MJCF(mechanism, motion(mechanism, at=[initial_place(mechanism)])).encode()}
