"""Files of figures, and what drawing them loads and leaves alone."""

from __future__ import annotations

import subprocess
import sys
import tempfile

import matplotlib
import pytest
from matplotlib.figure import Figure

from centrode import locale, render
from centrode.errors import InputError
from centrode.render.figures.files import save_figures
from shown_motion import motion_figures


def lines(figure: Figure, name: str, panel: int = 0):
    """The lines of a name in a panel of a figure."""
    return [line for line in figure.axes[panel].get_lines() if line.get_label() == name]


def test_files_repeat_their_bytes(make, tmp_path):
    written = []
    for folder in ("one", "two"):
        (tmp_path / folder).mkdir()
        mechanism, dataset = make("press", samples=31)
        figures = motion_figures(mechanism, dataset, only=["mechanism", "velocities"])
        written.append(save_figures(figures, tmp_path / folder))
        save_figures(figures, tmp_path / folder)
    assert [path.name for path in written[0]] == [
        "mechanism.png",
        "mechanism.svg",
        "velocities.png",
        "velocities.svg",
    ]
    for first, second in zip(*written, strict=True):
        assert first.read_bytes() == second.read_bytes()
        assert b"Matplotlib" not in first.read_bytes()[:2000] or first.suffix == ".svg"


def test_the_users_settings_are_left_alone_and_do_not_matter(make):
    mechanism, dataset = make("worked", samples=11)
    with matplotlib.rc_context({"lines.linewidth": 9.0, "font.size": 30.0}):
        before = matplotlib.rcParams.copy()
        figures = motion_figures(mechanism, dataset, only=["angles", "mechanism"])
        assert matplotlib.rcParams.copy() == before
    assert lines(figures["angles"], "OA")[0].get_linewidth() == 1.5


def test_figures_speak_the_chosen_language(make, monkeypatch):
    monkeypatch.setattr(locale._catalogue, "gettext", lambda message: f"«{message}»", raising=False)
    mechanism, dataset = make("worked", samples=11)
    figures = motion_figures(mechanism, dataset, only=["angles"])
    assert figures["angles"].get_suptitle().startswith("«Angles of the links»")


def test_tables_import_no_matplotlib():
    code = (
        "import sys; from centrode import render; render.write_tables;"
        "assert not {'matplotlib', 'pint'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_missing_matplotlib_is_told_with_its_repair(monkeypatch):
    loaded = ("matplotlib", "centrode.scenes.", "centrode.render.")
    for name in [name for name in sys.modules if name.startswith(loaded)]:
        monkeypatch.delitem(sys.modules, name)
    for name in ("figures_of", "figure_of", "write_pictures"):
        monkeypatch.delitem(render.__dict__, name, raising=False)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(InputError, match=r'pip install -e "\.\[figures\]"'):
        _ = render.figures_of


def test_pyplot_is_never_loaded():
    """Loading it would choose a backend, which may want a display."""
    code = (
        "import sys; from matplotlib.figure import Figure; from centrode import render;"
        "from centrode.render.figures.files import save_figures;"
        "render.figures_of, save_figures({'empty': Figure()}, sys.argv[1]);"
        "assert 'matplotlib.pyplot' not in sys.modules"
    )
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, "-c", code, folder], check=True)
