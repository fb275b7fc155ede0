"""Files of a description: of a topic its tables, of the whole a report, a drawing, a model, a page."""

from __future__ import annotations

import io
import re
import tempfile
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from centrode import render
from centrode.app.documents import Document
from centrode.app.frames import frame_bytes
from centrode.app.panels import topic_named, topic_sheet
from centrode.dynamics.masses import has_masses_or_loads
from centrode.errors import InputError
from centrode.kinematics.motion import initial_place, motion, motion_among
from centrode.locale import _, chosen_language, mark
from centrode.model.mechanism import Mechanism
from centrode.render.table_files import TableSpelling
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
REPORT = Lazily("centrode.report.document", "report")
DOCUMENT = Lazily("centrode.report.files", "document")
PAGE = Lazily("centrode.report.mechanism_page.page_file", "mechanism_page")
DRAWING = Lazily("centrode.render.drafting.sheet", "mechanism_drawing")
SCALE = Lazily("centrode.render.drafting.scales", "read_scale")
DRAWING_FILES = {
    "dxf": Lazily("centrode.render.drafting.dxf", "write_drawing_dxf"),
    "svg": Lazily("centrode.render.drafting.svg", "write_drawing_svg"),
}
TYPES = {
    "csv": "text/csv; charset=utf-8",
    "xlsx": "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet",
    "zip": "application/zip",
    "toml": "text/plain; charset=utf-8",
    "html": "text/html; charset=utf-8",
    "pdf": "application/pdf",
    "docx": "application/vnd.openxmlformats-officedocument.wordprocessingml.document",
    "ipynb": "application/x-ipynb+json",
    "dxf": "image/vnd.dxf",
    "svg": "image/svg+xml",
    "xml": "application/xml",
    "urdf": "application/xml",
    "sdf": "application/xml",
    "fmu": "application/zip",
    "FCMacro": "text/plain; charset=utf-8",
    "c": "text/plain; charset=utf-8",
    "py": "text/x-python; charset=utf-8",
    "m": "text/plain; charset=utf-8",
    "js": "text/javascript; charset=utf-8",
}
"""Ending of a file -> its type."""
EXPORTS = {
    "report": (mark("Report"), ("html", "pdf", "docx", "ipynb")),
    "drawing": (mark("Drawing to scale"), ("dxf", "svg")),
    "page": (mark("Page to change dimensions on"), ("html",)),
    **MODELS,
}
"""What is written of the whole description, and the endings of its files."""
SCALES = re.compile(r"[0-9]{1,4}(?:\.[0-9]{1,3})?:[0-9]{1,4}(?:\.[0-9]{1,3})?")


def export_list() -> list[dict[str, Any]]:
    """Name, title and formats of what is written of the whole, in the chosen language."""
    return [
        {
            "name": name,
            "title": _(title),
            "formats": list(kinds),
            "for": None if name == "report" else "mechanism",
        }
        for name, (title, kinds) in EXPORTS.items()
    ]


def file_answer(name: str, content: bytes) -> bytes:
    """A file as an answer."""
    ending = name.rpartition(".")[2]
    frame = frame_bytes({"name": name, "type": TYPES.get(ending, "application/octet-stream")}, {})
    return frame + content


def exported_file(document: Document, topic: object, kind: object, options: object) -> bytes:
    """The file of a topic or of the whole in a format; raises CentrodeError where there is none."""
    stem = file_stem(document)
    if isinstance(topic, str) and topic in EXPORTS:
        if kind not in EXPORTS[topic][1]:
            raise _unknown_format(kind, EXPORTS[topic][1])
        table: Mapping[Any, Any] = options if isinstance(options, Mapping) else {}
        return _of_whole(document, topic, str(kind), table, stem)
    chosen = topic_named(topic)
    if kind not in ("csv", "xlsx"):
        raise _unknown_format(kind, ("csv", "xlsx"))
    sheet, description = topic_sheet(document, chosen, options, None)
    with tempfile.TemporaryDirectory(prefix="centrode-") as folder:
        spelling = TableSpelling(xlsx=kind == "xlsx", comma=False)
        spelling.check()
        for table_name, rows in sheet.tables.items():
            path = Path(folder) / f"{table_name}.csv"
            path.parent.mkdir(parents=True, exist_ok=True)
            render.write_table(rows, path, description.display, spelling)
        files = sorted(Path(folder).rglob(f"*.{kind}"))
        if not files:
            raise InputError("", _("this topic has no tables here"))
        if len(files) == 1:
            return file_answer(f"{stem}-{files[0].stem}.{kind}", files[0].read_bytes())
        contents = {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}
    return _one_file(contents, f"{stem}-{chosen.name}.zip")


def _one_file(files: Mapping[str, bytes], archive: str) -> bytes:
    """A file as an answer; of several an archive."""
    if len(files) > 1:
        return file_answer(archive, _archive(files))
    ((name, content),) = files.items()
    return file_answer(name, content)


def _archive(files: Mapping[str, bytes]) -> bytes:
    """Files in an archive; the same files give the same bytes."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(zipfile.ZipInfo(name), content, zipfile.ZIP_DEFLATED)
    return stream.getvalue()


def _unknown_format(kind: object, known: tuple[str, ...]) -> InputError:
    return InputError(
        "", _("there is no such format"), _("use one of {known}").format(known=", ".join(known))
    )


def file_stem(document: Document) -> str:
    """A name for files: the title in letters that every system takes."""
    title = str(document.tables.get("title") or "mechanism")
    return re.sub(r"[^\w-]+", "-", title).strip("-_")[:60] or "mechanism"


def _of_whole(document: Document, topic: str, kind: str, options: Mapping[Any, Any], stem: str) -> bytes:
    if topic == "report":
        described = document.cam if document.cam is not None else document.require_mechanism()
        if isinstance(described, Mechanism):
            document.require_prepared()
        made = REPORT(described, language=chosen_language(), name=stem)
        files = DOCUMENT(made, kind, stem)
        (content,) = files.values()
        return file_answer(f"{stem}.{kind}", content)
    mechanism = document.require_mechanism()
    document.require_prepared()
    if topic in MODELS:
        return _one_file(model_files(mechanism, kind, stem), f"{stem}-{kind}.zip")
    if topic == "page":
        return file_answer(
            f"{stem}.html", PAGE(mechanism, language=chosen_language(), source=f"{stem}.toml").encode()
        )
    scale = options.get("scale", "1:1")
    if not isinstance(scale, str) or not SCALES.fullmatch(scale):
        raise InputError("scale", _("a scale is two numbers, such as 1:5"))
    course = motion(mechanism)
    at, sample = motion_among(mechanism, course, initial_place(mechanism))
    drawing = DRAWING(mechanism, at, sample, (), [], True, course, str, SCALE(scale, "scale"))
    with tempfile.TemporaryDirectory(prefix="centrode-") as folder:
        path = Path(folder) / f"drawing.{kind}"
        DRAWING_FILES[kind](drawing, path)
        return file_answer(f"{stem}.{kind}", path.read_bytes())


# For other programs: models of robots and simulators, a macro of a drawing program, source files.


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
