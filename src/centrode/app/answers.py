"""What the workbench answers: a function of a message, with what is kept of the descriptions seen last."""

from __future__ import annotations

import math
import traceback
from base64 import b64decode
from collections.abc import Callable, Mapping
from pathlib import Path, PurePath
from typing import Any, TypeAlias

from centrode.app.cam_scene import cam_scene
from centrode.app.completion import completions
from centrode.app.documents import TEXT_SIZE, Document, digest_of, read_document
from centrode.app.drive_space import has_free_place, initial_values, place_in_drive_space
from centrode.app.edit_drags import reshape
from centrode.app.exports import export_list, exported_file
from centrode.app.folders import WorkFolder
from centrode.app.frames import frame_bytes
from centrode.app.gear_bench import gear_answer
from centrode.app.motion_frames import motion_answer
from centrode.app.move_drags import place_on_way, way_of
from centrode.app.operations import apply_operations
from centrode.app.panel_titles import failure_texts, with_panel_titles
from centrode.app.panels import panel_of, topic_list, topics_of
from centrode.app.patches import Patch
from centrode.app.readiness import readiness_of
from centrode.app.scene import scene_of
from centrode.app.screen_sentences import SCREEN_SENTENCES
from centrode.app.sketch import SketchParts
from centrode.app.synthesis_bench import synthesis_answers, synthesis_state
from centrode.app.templates import template_list
from centrode.app.words import spoken_words
from centrode.errors import CentrodeError, InputError
from centrode.locale import LANGUAGES, _, chosen_language, decimal_mark, speaking
from centrode.model.examples import example_text
from centrode.model.files import mechanism_text
from centrode.model.pmks import from_pmks
from centrode.numerics.arrays import ARRAYS
from centrode.quantities import UNIT_SYMBOLS, spelled_unit
from centrode.topics.topic import Lazily
from centrode.version import __version__

import numpy as np  # isort: skip

Message: TypeAlias = Mapping[str, Any]
Answer: TypeAlias = dict[str, Any] | bytes

SKETCH = Lazily("centrode.sketches.imported_sketch", "sketch_content")
KEPT_TEXTS = 64
"""Texts that are known by their digest."""
CAM_READINESS: Mapping[str, Any] = {"mobility": None, "facts": [], "loose": [], "missing": [], "limit": None}
OPERATIONS = 200
"""Operations of one message."""
LANGUAGE_NAMES = {"en": "English", "ru": "Русский", "uk": "Українська"}


class UnknownText(Exception):
    """The text of a digest is not here (any more)."""

    def __init__(self, digest: str) -> None:
        self.digest = digest
        super().__init__(digest)


class Workbench:
    """Answers messages about descriptions; it holds nothing that a message could not bring again.

    Parameters
    ----------
    work : the folder whose files may be read and written
    """

    def __init__(self, work: WorkFolder) -> None:
        self.work = work
        self._texts: dict[str, str] = {}
        self._names: dict[str, Callable[[Message], Answer]] = {
            "hello": self.hello,
            "read": self.read,
            "edit": self.edit,
            "drag": self.drag,
            "motion": self.motion,
            "example": self.example,
            "files": self.files,
            "open": self.open,
            "save": self.save,
            "panel": self.panel,
            "complete": self.complete,
            "import": self.import_link,
            "export": self.export,
            "page": self.page,
            "gears": gear_answer,
            "synthesis": lambda message: synthesis_state(message, work.folder),
            "synthesise": lambda message: synthesis_answers(message, work.folder),
        }

    def answer(self, message: Message) -> Answer:
        """Answer a message; whatever is wrong with it or with what it holds is an answer too."""
        number = message.get("id")
        number = number if isinstance(number, int) and not isinstance(number, bool) else 0
        language = message.get("language")
        with speaking(language if language in LANGUAGES else "en", SCREEN_SENTENCES):
            try:
                name = message.get("do")
                handle = self._names.get(name) if isinstance(name, str) else None
                if handle is None:
                    raise InputError("", _("the server does not know this request"))
                answer = handle(message)
            except UnknownText as unknown:
                return {"id": number, "unknown": unknown.digest}
            except CentrodeError as failure:
                what, repair = failure_texts(failure)
                return {"id": number, "error": {"message": what, "repair": repair}}
            except (RecursionError, MemoryError):
                what = _("this takes more memory than the workbench has")
                return {"id": number, "error": {"message": what, "repair": ""}}
        if isinstance(answer, bytes):
            return answer
        return {"id": number, **answer}

    def fault(self, message: Message, fault: Exception) -> dict[str, Any]:
        """The answer to a message that met a fault of the program."""
        number, language = message.get("id"), message.get("language")
        with speaking(language if language in LANGUAGES else "en"):
            said = "".join(traceback.format_exception_only(fault)).strip()[:500]
            what = _("this is an error in centrode: {fault}").format(fault=said)
            repair = _("please report it with the description")
        return {"id": number if isinstance(number, int) else 0, "error": {"message": what, "repair": repair}}

    # texts

    def _text(self, message: Message) -> str:
        text = message.get("text")
        if text is None:
            digest = message.get("digest")
            if not isinstance(digest, str):
                raise InputError("", _("the message names no description"))
            if digest not in self._texts:
                raise UnknownText(digest[:64])
            return self._texts[digest]
        if not isinstance(text, str):
            raise InputError("", _("the message names no description"))
        if len(text) > TEXT_SIZE:
            what = _("the text has {size} characters, at most {most} are allowed")
            raise InputError("", what.format(size=len(text), most=TEXT_SIZE), _("shorten it"))
        self._keep(text)
        return text

    def _keep(self, text: str) -> str:
        digest = digest_of(text)
        self._texts.pop(digest, None)
        self._texts[digest] = text
        while len(self._texts) > KEPT_TEXTS:
            del self._texts[next(iter(self._texts))]
        return digest

    def document(self, message: Message) -> Document:
        """The description that a message is about."""
        return read_document(self._text(message), self.work.folder)

    # answers

    def hello(self, message: Message) -> Answer:
        """What the page needs to begin."""
        return {
            "version": __version__,
            "language": chosen_language(),
            "languages": [{"code": code, "name": LANGUAGE_NAMES[code]} for code in LANGUAGES],
            "words": spoken_words(),
            "units": {symbol: spelled_unit(symbol) for symbol in UNIT_SYMBOLS},
            "templates": template_list(),
            "file": self.work.first_file(),
            "folder": digest_of(str(self.work.folder))[:16],
            "topics": topic_list(),
            "exports": export_list(),
            "decimal": decimal_mark(),
        }

    def read(self, message: Message) -> Answer:
        """A description as a scene, with its problems and what it lacks to move."""
        return self._description_answer(self.document(message))

    def _description_answer(self, document: Document) -> dict[str, Any]:
        digest = self._keep(document.text)
        if document.is_cam:
            scene, readiness = cam_scene(document), {"ready": document.cam is not None, **CAM_READINESS}
        else:
            sketch = SketchParts(document)
            scene, readiness = scene_of(sketch), readiness_of(sketch)
        return {
            "text": document.text,
            "digest": digest,
            "scene": {**scene, "topics": topics_of(document)},
            "problems": [problem.as_dict() for problem in document.problems],
            "readiness": readiness,
        }

    def edit(self, message: Message) -> Answer:
        """A description after operations; nothing changes where one of them is refused."""
        operations = message.get("operations")
        if not isinstance(operations, list) or not all(isinstance(one, dict) for one in operations):
            raise InputError("", _("the operations are a list of tables"))
        if len(operations) > OPERATIONS:
            what = _("{count} operations are given, at most {most} are allowed")
            raise InputError("", what.format(count=len(operations), most=OPERATIONS))
        patch = apply_operations(self._text(message), self.work.folder, operations)
        return self._patch_answer(patch)

    def _patch_answer(self, patch: Patch) -> Answer:
        described = self._description_answer(read_document(patch.text, self.work.folder))
        changed = list(dict.fromkeys(patch.changed))
        return {**described, "changed": changed, "named": patch.named, "held": patch.held}

    def drag(self, message: Message) -> Answer:
        """Where everything stands while a point is dragged; the description after it, where it is dropped."""
        document, point, to = self.document(message), message.get("point"), _place_of(message.get("to"))
        if not isinstance(point, str):
            raise InputError("", _("the message names no point"))
        if len(to) != (3 if SketchParts(document).on_sphere else 2):
            raise InputError("", _("a place is two numbers, on the sphere three"))
        if message.get("mode") == "move" and has_free_place(document):
            return self._drives_answer(message, document, point, to)
        if message.get("mode") == "move":
            return self._move_answer(message, document, point, to)
        sketch = SketchParts(document)
        if message.get("drop"):
            move = {"do": "move_point", "point": point, "to": list(to)}
            return self._patch_answer(apply_operations(document.text, self.work.folder, [move]))
        reshaped = reshape(sketch, point, to, self.work.folder)
        places = [list(reshaped.places.get(name, (math.nan, math.nan))) for name in sketch.points]
        angles = [math.nan] * len(sketch.links)
        if reshaped.prepared is not None:
            angles = [reshaped.prepared.assembled.angles.get(name, math.nan) for name in sketch.links]
        header = {"id": message.get("id", 0), "values": dict(reshaped.values), "held": reshaped.held or None}
        return frame_bytes({**header, "status": [0]}, {"points": places, "angles": angles})

    def _move_answer(self, message: Message, document: Document, point: str, to: tuple[float, ...]) -> Answer:
        way = way_of(document)
        drive = message.get("drive")
        present = float(drive) if isinstance(drive, int | float) and _is_finite(drive) else None
        at = place_on_way(way, point, np.asarray(to), present)
        points, angles, status = way.at(at)
        header = {"id": message.get("id", 0), "at": at, "status": [status], "values": {}, "held": None}
        return frame_bytes(header, {"points": points, "angles": angles})

    def _drives_answer(
        self, message: Message, document: Document, point: str, to: tuple[float, ...]
    ) -> Answer:
        """Where a point of a mechanism with several drives, or without laws, is nearest to the cursor."""
        sketch, prepared = SketchParts(document), document.position
        assert prepared is not None
        if point not in prepared.mechanism.moving_points:
            raise InputError(point, _("this point does not move"))
        values = initial_values(prepared)
        given, time = message.get("drives"), message.get("drive")
        if isinstance(given, Mapping):
            values |= {name: float(given[name]) for name in values if _is_finite(given.get(name))}
        elif document.prepared is not None and _is_finite(time):
            moved = prepared.kinematics.path.drive_values(ARRAYS, np.float64(time))
            values |= {name: float(value) for name, value in moved.items()}
        position = place_in_drive_space(prepared, point, np.asarray(to), values)
        if message.get("drop"):
            starts = {"do": "set_starts", "drives": position.values}
            return self._patch_answer(apply_operations(document.text, self.work.folder, [starts]))
        absent = np.full(len(to), math.nan)
        points = [position.points.get(name, absent) for name in sketch.points]
        angles = [position.angles.get(name, math.nan) for name in sketch.links]
        header = {"id": message.get("id", 0), "drives": position.values, "status": [0], "values": {}}
        return frame_bytes({**header, "held": None}, {"points": points, "angles": angles})

    def motion(self, message: Message) -> Answer:
        """The motion of the description over its range."""
        document = self.document(message)
        samples = message.get("samples")
        count = samples if isinstance(samples, int) and not isinstance(samples, bool) else None
        try:
            header, arrays = motion_answer(document.require_prepared(), count)
        except CentrodeError as failure:
            return {"missing": with_panel_titles(failure.what), "repair": with_panel_titles(failure.repair)}
        return frame_bytes({"id": message.get("id", 0), **header}, arrays)

    def example(self, message: Message) -> Answer:
        """The text of a built-in description."""
        name = message.get("name")
        if not isinstance(name, str):
            raise InputError("", _("the message names no built-in mechanism"))
        text = example_text(name)
        return {"name": name, "text": text, "digest": self._keep(text)}

    def import_link(self, message: Message) -> Answer:
        """The text of a description from a link of PMKS+, or from a drawing."""
        if "content" in message:
            return self._import_drawing(message)
        url = message.get("url")
        if not isinstance(url, str):
            raise InputError("", _("a link is a text"))
        text = mechanism_text(from_pmks(url))
        return {"text": text, "digest": self._keep(text)}

    def _import_drawing(self, message: Message) -> Answer:
        """A drawing in Base64 as a description, with what was guessed and left out."""
        name, content = message.get("name"), message.get("content")
        if not (isinstance(name, str) and isinstance(content, str)):
            raise InputError("", _("a drawing has a name and a content"))
        try:
            drawing = b64decode(content, validate=True)
        except ValueError:
            raise InputError("", _("the content of a drawing is in Base64")) from None
        read = SKETCH(drawing, name[:100], PurePath(name).suffix.lower())
        told = [_("guessed: {what}").format(what=one) for one in read.guesses]
        told += [_("not read: {what}").format(what=one) for one in read.omitted]
        return {"text": read.text, "digest": self._keep(read.text), "told": told}

    def panel(self, message: Message) -> Answer:
        """What a topic has to say about the description; with the motions that it has found as a frame."""
        panel, arrays = panel_of(
            self.document(message),
            message.get("topic"),
            message.get("options"),
            message.get("samples"),
            message.get("room"),
        )
        return frame_bytes({"id": message.get("id", 0), **panel}, arrays) if arrays else panel

    def complete(self, message: Message) -> Answer:
        """What may stand at a place of the text."""
        line, column = message.get("line"), message.get("column")
        if not all(isinstance(one, int) and not isinstance(one, bool) for one in (line, column)):
            raise InputError("", _("a place in a text is a line and a column"))
        assert isinstance(line, int) and isinstance(column, int)
        return completions(self.document(message), line, column)

    def export(self, message: Message) -> Answer:
        """A file of a topic or of the whole description."""
        document = self.document(message)
        return exported_file(document, message.get("topic"), message.get("format"), message.get("options"))

    def page(self, message: Message) -> Answer:
        """The description as one page that computes itself."""
        return exported_file(self.document(message), "page", "html", {})

    # files

    def files(self, message: Message) -> Answer:
        """Names of the descriptions in the folder."""
        return {"files": self.work.names()}

    def open(self, message: Message) -> Answer:
        """The text of a file of the folder."""
        name = self.work.checked_name(message.get("name"))
        text = self.work.read(name)
        return {"name": name, "text": text, "digest": self._keep(text)}

    def save(self, message: Message) -> Answer:
        """Write a file of the folder, unless somebody else has changed it meanwhile."""
        name, expected = self.work.checked_name(message.get("name")), message.get("expected")
        text = self._text(message)
        self.work.write(name, text, expected if isinstance(expected, str) else None)
        return {"name": name, "digest": self._keep(text)}


def _place_of(value: object) -> tuple[float, ...]:
    """A place that a message holds; InputError for anything else."""
    if isinstance(value, list) and 2 <= len(value) <= 3:
        numbers = [float(one) for one in value if isinstance(one, int | float) and not isinstance(one, bool)]
        if len(numbers) == len(value) and all(math.isfinite(one) and abs(one) < 1e9 for one in numbers):
            return tuple(numbers)
    raise InputError("", _("a place is two numbers, on the sphere three"))


def _is_finite(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def path_of_folder(file: Path | None) -> Path:
    """The folder of a file, or the working folder."""
    return (file.parent if file is not None else Path()).resolve()
