"""Moves of modules by a table, on small packages."""

from pathlib import Path

from tools.moves.engine import Moves
from tools.moves.sources import Source
from tools.moves.table import Table, dotted


def moved(
    files: dict[str, str], modules: dict[str, str], names: dict[str, str] | None = None
) -> tuple[dict[str, str], list[str]]:
    """New texts and open questions of a package of some files, by paths below it; others have a slash in front."""
    sources = {}
    for place, text in files.items():
        path = Path(place[1:]) if place.startswith("/") else Path("src/centrode") / place
        sources[path] = Source(path, text)
    keys = {tuple(key.split(":")): new for key, new in (names or {}).items()}
    table = Table(
        modules={new: tuple(old.split()) for new, old in modules.items()},
        names={(dotted(module), name): new for (module, name), new in keys.items()},
    )
    moves = Moves(table, sources)
    texts, _gone = moves.results()
    return {str(path): text for path, text in texts.items()}, moves.questions


def test_imports_between_parts_vanish_and_definitions_come_first() -> None:
    files = {
        "a/one.py": '"""One."""\n\nfrom centrode.a.two import LEAST\n\nTWICE = 2 * LEAST  # why\n',
        "a/two.py": '"""Two."""\n\nLEAST = 1\n"""At least."""\n',
        "b.py": "from centrode.a.one import TWICE\nfrom centrode.a.two import LEAST\n\nprint(TWICE, LEAST)\n",
    }
    texts, questions = moved(files, {"a/both": "a/one a/two"})
    assert not questions
    both = texts["src/centrode/a/both.py"]
    assert both.startswith('"""One."""') and "# why" in both and "import LEAST" not in both
    assert both.index("LEAST = 1") < both.index("TWICE = 2 * LEAST")
    assert (
        texts["src/centrode/b.py"]
        == "from centrode.a.both import TWICE\nfrom centrode.a.both import LEAST\n\nprint(TWICE, LEAST)\n"
    )


def test_names_that_mean_several_things_are_questions_until_the_table_answers() -> None:
    files = {
        "a/one.py": "def _at(x):\n    return x\n\n\ndef first(x):\n    return _at(x)\n",
        "a/two.py": "def _at(x):\n    return -x\n\n\ndef second(x):\n    return _at(x)\n",
    }
    modules = {"a/both": "a/one a/two"}
    _texts, questions = moved(files, modules)
    assert len(questions) == 1 and "_at" in questions[0]
    texts, questions = moved(files, modules, {"a/two:_at": "_opposite"})
    assert not questions
    scope: dict[str, object] = {}
    exec(texts["src/centrode/a/both.py"], scope)
    assert scope["first"](2) == 2 and scope["second"](2) == -2  # type: ignore[operator]


def test_what_two_parts_define_in_the_same_words_is_kept_once() -> None:
    definition = "from typing import Any, TypeAlias\n\nNumber: TypeAlias = Any\n"
    texts, questions = moved({"a/one.py": definition, "a/two.py": definition}, {"a/both": "a/one a/two"})
    assert not questions
    assert texts["src/centrode/a/both.py"].count("Number: TypeAlias = Any") == 1


def test_names_of_a_module_that_is_imported_itself() -> None:
    files = {
        "a/one.py": "def f(x):\n    return x\n",
        "a/two.py": "from centrode.a import one\n\n\ndef g(x):\n    return one.f(x) + 1\n",
        "/tests/test_a.py": "from centrode.a import one\n\n\ndef test(both):\n    assert one.f(both)\n",
    }
    texts, questions = moved(files, {"a/both": "a/one a/two"})
    assert not questions
    assert "return f(x) + 1" in texts["src/centrode/a/both.py"]
    assert "from centrode.a import both as a_both" in texts["tests/test_a.py"]  # `both` is a local name there
    assert "a_both.f(both)" in texts["tests/test_a.py"]


def test_a_local_name_that_hides_what_a_member_becomes_is_a_question() -> None:
    files = {
        "a/one.py": "def angle(x):\n    return x\n",
        "a/two.py": "from centrode.a import one\n\n\ndef g(angle):\n    return one.angle(angle)\n",
    }
    _texts, questions = moved(files, {"a/both": "a/one a/two"})
    assert any("local name" in question for question in questions)


def test_a_local_name_is_left_alone_when_a_definition_of_its_name_changes() -> None:
    files = {
        "a/one.py": "class Pull:\n    pass\n\n\ndef f(Pull):\n    return Pull\n\n\ndef g():\n    return Pull\n",
        "b.py": "from centrode.a.one import Pull\n\nsaid = 'Pull'\nmade = Pull()\n",
    }
    texts, questions = moved(files, {"a/wrench": "a/one"}, {"a/one:Pull": "Wrench"})
    assert not questions
    assert "def f(Pull):\n    return Pull" in texts["src/centrode/a/wrench.py"]
    assert "def g():\n    return Wrench" in texts["src/centrode/a/wrench.py"]
    assert (
        texts["src/centrode/b.py"]
        == "from centrode.a.wrench import Wrench\n\nsaid = 'Pull'\nmade = Wrench()\n"
    )


def test_imports_for_type_checking_are_joined() -> None:
    block = "from typing import TYPE_CHECKING\n\nif TYPE_CHECKING:\n    from centrode.b import B\n\n\n"
    files = {
        "a/one.py": f"{block}def f(b: B) -> None: ...\n",
        "a/two.py": f"{block}def g(b: B) -> None: ...\n",
        "b.py": "class B:\n    pass\n",
    }
    texts, questions = moved(files, {"a/both": "a/one a/two"})
    assert not questions
    assert texts["src/centrode/a/both.py"].count("if TYPE_CHECKING:\n    from centrode.b import B\n") == 1


def test_strings_that_name_modules_follow() -> None:
    files = {
        "a/one.py": "MOST = 3\n",
        "/tests/test_a.py": 'def test(monkeypatch):\n    monkeypatch.setattr("centrode.a.one.MOST", 4)\n',
        "/pyproject.toml": '[[tool.importlinter.contracts]]\nmodules = [\n    "centrode.a.one",\n]\n',
    }
    texts, questions = moved(files, {"a/limits": "a/one"}, {"a/one:MOST": "GREATEST"})
    assert not questions
    assert '"centrode.a.limits.GREATEST"' in texts["tests/test_a.py"]
    assert '"centrode.a.limits"' in texts["pyproject.toml"]


def test_formatted_strings_follow() -> None:
    files = {"a/one.py": 'LEAST = 1\n\n\ndef f():\n    return f"LEAST {LEAST:.3f}"\n'}
    texts, questions = moved(files, {"a/two": "a/one"}, {"a/one:LEAST": "SMALLEST"})
    assert not questions
    assert 'f"LEAST {SMALLEST:.3f}"' in texts["src/centrode/a/two.py"]


def test_modules_that_would_import_each_other_are_found() -> None:
    files = {
        "a/one.py": "X = 1\n",
        "a/two.py": "from centrode.a.one import X\n\nY = X\n",
        "a/three.py": "from centrode.a.two import Y\n\nZ = Y\n",
    }
    sources = {
        Path("src/centrode") / path: Source(Path("src/centrode") / path, text) for path, text in files.items()
    }
    moves = Moves(Table(modules={"a/both": ("a/one", "a/three")}), sources)
    assert moves.circles()


def test_names_of_a_face_that_ceases_are_taken_from_their_modules() -> None:
    files = {
        "a/__init__.py": "import lazy_loader\n",
        "a/__init__.pyi": "from .one import f as f\n",
        "a/one.py": "def f(x):\n    return x\n",
        "__init__.pyi": "from .a import f as f\n",
        "/tests/test_a.py": "from centrode.a import f\n\nassert f(1)\n",
    }
    faces = ("src/centrode/a/__init__.py", "src/centrode/a/__init__.pyi")
    sources = {}
    for place, text in files.items():
        path = Path(place[1:]) if place.startswith("/") else Path("src/centrode") / place
        sources[path] = Source(path, text)
    moves = Moves(Table(modules={"b/two": ("a/one",)}, gone=faces), sources)
    texts, gone = moves.results()
    assert not moves.questions and {Path(face) for face in faces} <= gone
    assert texts[Path("src/centrode/__init__.pyi")] == "from .b.two import f as f\n"
    assert texts[Path("tests/test_a.py")].startswith("from centrode.b.two import f\n")
