"""The house at a glance: rooms and their sizes, long functions, names, import cycles, hidden imports.

Run as `python -m tools.house [FOLDER]`; the folder is `src` if left out.
"""

from __future__ import annotations

import ast
import collections
import statistics
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

SOURCE = Path(__file__).resolve().parent.parent / "src"
NOUNS = {
    "bearing", "spring", "gearing", "reading", "coupling", "damping", "balancing", "spelling", "drawing", "engineering",
    "drafting", "bed", "speed", "seed", "feed", "embed",
}  # fmt: skip
"""Names that end as participles do and are nouns or verbs."""
SMALL = 60
"""Lines below which a module may be a topic cut in pieces."""
SHOWN = 12

Functions = (ast.FunctionDef, ast.AsyncFunctionDef)
Documented = (ast.Module, ast.ClassDef, *Functions)


@dataclass
class Module:
    """What is counted in one file.

    Attributes
    ----------
    code : lines that are neither blank, comments nor docstrings
    functions : lines without docstring, and name, of each function
    imported : modules of the same tree
    hidden : lines of imports inside functions
    """

    name: str
    lines: int
    comments: int
    code: int
    functions: list[tuple[int, str]] = field(default_factory=list)
    classes: list[str] = field(default_factory=list)
    imported: set[str] = field(default_factory=set)
    hidden: list[int] = field(default_factory=list)


def main(words: Sequence[str] | None = None) -> int:
    """Print the counts of a folder; returns the exit code."""
    given = sys.argv[1:] if words is None else words
    root = Path(given[0]) if given else SOURCE
    modules = read_modules(root)
    if not modules:
        print(f"no Python files under {root}", file=sys.stderr)
        return 2
    print("\n".join([*rooms(modules), "", *counts(modules, root / "centrode" / "__init__.pyi")]))
    return 0


def read_modules(root: Path) -> list[Module]:
    """Every module below a folder."""
    files = sorted(path for path in root.rglob("*.py") if "__pycache__" not in path.parts)
    names = {path: _name(path.relative_to(root)) for path in files}
    return [_module(path, name, set(names.values())) for path, name in names.items()]


def rooms(modules: Sequence[Module]) -> Iterator[str]:
    """A line for each room: files, lines, the largest file."""
    inside: dict[str, list[Module]] = collections.defaultdict(list)
    for module in modules:
        inside[".".join(module.name.split(".")[:2])].append(module)
    for room, members in sorted(inside.items()):
        largest = max(members, key=lambda module: (module.lines, module.name))
        lines = sum(module.lines for module in members)
        last = largest.name.split(".")[-1]
        yield f"{room:34s} {len(members):3d} files {lines:6d} lines   largest {largest.lines:5d} {last}"


def counts(modules: Sequence[Module], face: Path) -> Iterator[str]:
    """Lines with what is counted over all modules."""
    lines = [module.lines for module in modules]
    functions = sorted(one for module in modules for one in module.functions)
    long = functions[int(0.95 * (len(functions) - 1))][0] if functions else 0
    sizes = f"{len(modules)} files, {sum(lines)} lines, median file {statistics.median(lines):.0f}"
    yield f"{sizes}; {len(functions)} functions, p95 {long} lines"
    yield "longest functions: " + ", ".join(f"{name} {size}" for size, name in functions[:-6:-1])
    # the file of a package that only names it is no topic
    small = sum(
        module.code > 0 and module.lines < SMALL and module.name != "centrode.__main__" for module in modules
    )
    yield f"modules under {SMALL} lines: {small} (a topic cut in pieces?)"
    verbal = sorted(module.name.partition(".")[2] for module in modules if _verbal(module.name))
    yield f"modules named by a bare participle or gerund: {len(verbal)}: {_first(verbal, SHOWN)}"
    bare = sum(_participle(name.rpartition(".")[2]) for _size, name in functions)
    used = collections.Counter(name for module in modules for name in module.classes)
    shared = [count for count in used.values() if count > 1]
    repeated = f"class names used more than once: {len(shared)} for {sum(shared)} classes"
    yield f"functions that are a bare participle: {bare}; {repeated}"
    yield f"lines of code without comments, docstrings and blanks: {sum(module.code for module in modules)}"
    share = 100.0 * sum(module.comments for module in modules) / sum(lines)
    yield f"comment lines: {share:.1f} % (why stands next to the step?)"
    public = (
        sum(" import " in line for line in face.read_text(encoding="utf-8").splitlines())
        if face.exists()
        else 0
    )
    yield f"public names: {public or 'no stub'}"
    cycles = import_cycles({module.name: module.imported for module in modules})
    yield "import cycles: " + ("; ".join(" <-> ".join(cycle) for cycle in cycles) or "none")
    hidden = [f"{module.name}:{line}" for module in modules for line in module.hidden]
    yield "imports inside functions: " + (_first(hidden, SHOWN) or "none")


def import_cycles(edges: Mapping[str, set[str]]) -> list[list[str]]:
    """Strong components of more than one module, by Tarjan's algorithm."""
    index: dict[str, int] = {}
    low: dict[str, int] = {}
    stack: list[str] = []
    found = []

    def visit(module: str) -> None:
        index[module] = low[module] = len(index)
        stack.append(module)
        for other in sorted(edges[module]):
            if other not in index:
                visit(other)
                low[module] = min(low[module], low[other])
            elif other in stack:
                low[module] = min(low[module], index[other])
        if low[module] == index[module]:
            component = stack[stack.index(module) :]
            del stack[-len(component) :]
            if len(component) > 1:
                found.append(sorted(component))

    sys.setrecursionlimit(10_000)
    for module in edges:
        if module not in index:
            visit(module)
    return found


def _module(path: Path, name: str, known: set[str]) -> Module:
    text = path.read_text(encoding="utf-8")
    tree = ast.parse(text)
    nodes = list(ast.walk(tree))
    written = text.splitlines()
    comments = sum(line.lstrip().startswith("#") for line in written)
    filled = sum(bool(line.strip()) for line in written)
    documents = [ast.get_docstring(node, clean=False) or "" for node in nodes if isinstance(node, Documented)]
    documented = sum(bool(line.strip()) for document in documents for line in document.splitlines())
    made = Module(name, text.count("\n"), comments, filled - comments - documented)
    inside = {
        id(node) for function in nodes if isinstance(function, Functions) for node in ast.walk(function)
    }
    for node in nodes:
        if isinstance(node, ast.ClassDef):
            made.classes.append(node.name)
        if isinstance(node, Functions):
            made.functions.append((_size(node), f"{name}.{node.name}"))
        if isinstance(node, ast.Import | ast.ImportFrom):
            targets = {_target(one, known) for one in _imported(node, name, path.name == "__init__.py")}
            made.imported |= {target for target in targets if target is not None and target != name}
            if id(node) in inside:
                made.hidden.append(node.lineno)
    return made


def _size(function: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    document = ast.get_docstring(function)
    end = function.end_lineno or function.lineno
    return end - function.lineno + 1 - (document.count("\n") + 1 if document else 0)


def _imported(node: ast.Import | ast.ImportFrom, name: str, is_package: bool) -> list[str]:
    if isinstance(node, ast.Import):
        return [one.name for one in node.names]
    base = node.module or ""
    if node.level:
        package = name if is_package else name.rpartition(".")[0]
        for _level in range(node.level - 1):
            package = package.rpartition(".")[0]
        base = f"{package}.{base}".strip(".")
    return [f"{base}.{one.name}" for one in node.names]


def _target(name: str, known: set[str]) -> str | None:
    """The module that an imported name lies in."""
    while name and name not in known:
        name = name.rpartition(".")[0]
    return name or None


def _name(path: Path) -> str:
    return ".".join(path.with_suffix("").parts).removesuffix(".__init__")


def _verbal(module: str) -> bool:
    name = module.rpartition(".")[2]
    return name.endswith(("ing", "ed")) and name not in NOUNS


def _participle(function: str) -> bool:
    name = function.lstrip("_")
    return name.endswith("ed") and "_" not in name and name not in NOUNS


def _first(names: Sequence[str], count: int) -> str:
    return ", ".join(names[:count]) + (f", and {len(names) - count} more" if len(names) > count else "")


if __name__ == "__main__":
    sys.exit(main())
