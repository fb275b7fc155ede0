"""Commands, documents, renderers and notebooks know topics by the registry alone: none names a topic or its modules."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

import centrode
from centrode.topics.registry import TOPICS

SOURCE = Path(centrode.__file__).parent
ROOMS = ("cli", "notebook", "render", "report")
NAMES = {topic.name for topic in TOPICS}
MODULES = {function.module for topic in TOPICS for function in (topic.compute, topic.result, topic.view)}
VIEWS = "centrode.views"
ALLOWED = {
    # topics of many mechanisms have commands and folders of their own: they go on with what was interrupted
    "cli/sweep.py": {"centrode.sweeps.sweep"},
    "cli/variants.py": {"variants"},
    "report/variants/gear_folders.py": {"centrode.assignments.gear_variants"},
    "report/variants/answers.py": {"centrode.assignments.results"},
    # what a variant has integrated already is not integrated again for its report
    "report/variants/files.py": {"centrode.assignments.results", "centrode.equations.integration"},
    "report/variants/folders.py": {
        "centrode.assignments.results",
        "centrode.equations.integration",
        "centrode.sweeps.parameter_studies",
        "centrode.views",
    },
    # a document goes on with the run of its mechanism, and asks for points on guides, which equations name
    "report/study.py": {
        "centrode.dynamics.motion_results",
        "centrode.equations.derivation",
        "centrode.kinematics.check",
        "check",
        "run",
        "equations",
    },
    # sheets of drawings put parts of several results side by side
    "report/drawing_sheets.py": {
        "centrode.analysis.graphic.results",
        "centrode.analysis.position_plan",
        "centrode.dynamics.force_polygons.results",
        "centrode.dynamics.steady_motion.machine",
        "centrode.views.cam_sheets",
        "centrode.gears.results",
        "centrode.views.drawing_sheets",
        "centrode.views.gear_sheets",
        "centrode.views.path_sheets",
    },
    # the chapter of a repaired mechanism consists of those of other topics, and begins with what was changed
    "report/repaired_mechanism.py": {"centrode.views.single_changes"},
    # every document opens with the scheme of its mechanism
    "report/opening_pictures.py": {"centrode.views.schemes"},
    # a layer of a drawing at full size, not the topic
    "render/drafting/board.py": {"centrodes"},
    "render/drafting/sheet.py": {"centrodes"},
    # a group of curves, and a box that shows arrows
    "report/mechanism_page/courses.py": {"reactions"},
    "report/mechanism_page/page_file.py": {"reactions"},
    # a type of an option: points that counterweights stand on
    "cli/option_values.py": {"centrode.dynamics.balancing.balance"},
    # the kind of a block, not the topic
    "report/html/elements.py": {"check"},
    # formulas are Markdown in a notebook, other results are HTML
    "notebook/display.py": {"centrode.equations.derivation"},
}
"""What a module may name, each with its reason."""


def named_topics(text: str) -> Iterator[str]:
    """Names of topics, and modules of topics, that a module names."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom) and node.module is not None:
            imported = {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
            if imported & MODULES or node.module.startswith(VIEWS):
                yield node.module
        if isinstance(node, ast.Constant) and node.value in NAMES:
            yield str(node.value)


@pytest.mark.parametrize(
    "file",
    [path for room in ROOMS for path in sorted((SOURCE / room).rglob("*.py"))],
    ids=lambda path: path.relative_to(SOURCE).as_posix(),
)
def test_no_module_names_a_topic(file: Path) -> None:
    text = file.read_text(encoding="utf-8")
    assert set(named_topics(text)) <= ALLOWED.get(file.relative_to(SOURCE).as_posix(), set())


def test_what_is_allowed_is_needed() -> None:
    for name, allowed in ALLOWED.items():
        assert set(named_topics((SOURCE / name).read_text(encoding="utf-8"))) == allowed, name


def test_a_module_that_names_a_topic_is_seen() -> None:
    assert set(named_topics('from centrode.views.flywheel import sheet\nNAME = "flywheel"')) == {
        "centrode.views.flywheel",
        "flywheel",
    }
    assert set(named_topics("from centrode.dynamics.steady_motion import machine")) == {
        "centrode.dynamics.steady_motion"
    }
    assert not set(named_topics("from centrode.topics.registry import TOPICS"))
