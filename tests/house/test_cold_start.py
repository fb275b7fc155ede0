"""What the cheap commands do not import: looked up in `sys.modules` of a process of their own."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

PROBE = """
import json, sys
from centrode.cli.main import main
code = main(sys.argv[1:])
sys.stdout.flush()
print(json.dumps([code, sorted(sys.modules)]), file=sys.__stderr__)
"""
HEAVY = {"numpy", "scipy", "xarray", "pandas", "matplotlib", "sympy", "pint", "rich"}


def imported(*arguments: str) -> tuple[int, set[str]]:
    done = subprocess.run(
        [sys.executable, "-c", PROBE, *arguments],
        capture_output=True,
        encoding="utf-8",
        check=True,
    )
    code, modules = json.loads(done.stderr.splitlines()[-1])
    return code, {module.split(".")[0] for module in modules}


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (["--help"], 0),
        (["--version"], 0),
        (["--lang", "ru", "--help"], 0),
        (["examples", "--help"], 0),
        (["examples", "--lang", "fr"], 2),
        (["examples", "--out", "x.toml"], 2),
        (["no-such-command"], 2),
        (["--no-such-option"], 2),
        ([], 2),
    ],
)
def test_help_and_early_rejections_import_nothing_heavy(arguments: list[str], code: int) -> None:
    ended, modules = imported(*arguments)
    assert ended == code
    assert not modules & (HEAVY | {"pydantic"})


def test_listing_and_printing_examples_imports_no_numpy() -> None:
    code, modules = imported("examples")
    assert code == 0
    assert not modules & HEAVY
    code, modules = imported("examples", "slider-between-cranks")
    assert code == 0
    assert not modules & HEAVY


def test_importing_the_package_imports_nothing_heavy() -> None:
    text = "import sys, centrode; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, encoding="utf-8", check=True)
    assert not {module.split(".")[0] for module in done.stdout.split()} & (HEAVY | {"pydantic", "click"})


def test_a_command_leaves_the_library_of_chunked_arrays_aside(tmp_path: Path) -> None:
    """Where dask is installed xarray imports it at its first array: a fifth of a short command's time."""
    pytest.importorskip("dask")
    text = """
import json, sys
from centrode.cli.main import main
sys.argv[1:] = ["run", "crank-rocker", "--no-figures", "--out", "out"]
code = main()
print(json.dumps([code, "dask.array" in sys.modules, "dask" in sys.modules, "xarray" in sys.modules]), file=sys.stderr)
import dask.array
"""
    done = subprocess.run(
        [sys.executable, "-c", text], capture_output=True, encoding="utf-8", check=True, cwd=tmp_path
    )
    assert json.loads(done.stderr.splitlines()[-1]) == [0, False, False, True]


def test_a_free_motion_imports_no_scipy() -> None:
    """Its right side is a function of its own: SciPy takes longer to load than the motion takes."""
    text = """
import sys
import centrode as ct
from centrode.optional_packages import held_back
with held_back("dask"):
    ct.simulate(ct.example("double-pendulum"))
print(*sys.modules)
"""
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, encoding="utf-8", check=True)
    assert not {module.split(".")[0] for module in done.stdout.split()} & {"scipy", "matplotlib", "sympy"}


def test_a_library_that_is_held_back_is_let_in_again() -> None:
    text = """
import sys
from centrode.optional_packages import admitted_module, held_back
with held_back("wave"):
    try:
        import wave
    except ModuleNotFoundError:
        print("absent")
    print(admitted_module("wave", "wave").__name__, "wave" in sys.modules)
with held_back("wave"):
    import wave
with held_back("colorsys"):
    pass
import colorsys
"""
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, encoding="utf-8", check=True)
    assert done.stdout.split() == ["absent", "wave", "True"]
