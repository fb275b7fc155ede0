"""Methods of classes: which can be renamed without types, and where they are used."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

from tools.moves.sources import Edit, Source

Functions = (ast.FunctionDef, ast.AsyncFunctionDef)


@dataclass
class Renaming:
    """New names of methods that have one old name.

    Attributes
    ----------
    inside : module or path -> new name
        Files in which every attribute of the old name is the method.
    everywhere : new name, if every attribute of the old name in any file is the method
    """

    inside: dict[str, str] = field(default_factory=dict)
    everywhere: str | None = None

    def new(self, source: Source) -> str | None:
        """The new name in a source; None where the old one may mean something else."""
        return self.inside.get(source.module or "") or self.inside.get(str(source.path)) or self.everywhere


def agreed(
    methods: Mapping[tuple[str, str, str], str], modules: Mapping[str, Source]
) -> tuple[dict[str, Renaming], list[str]]:
    """Renamings by old names that no attribute of another meaning forbids, and notes on the rest.

    Attributes have no types here. So a method is renamed wherever its name is an attribute, if all classes of the
    package that have the name are in the table with the same new name. A private method is renamed in its own module
    if that holds there. A new name "solution in FILE ..." says in which files every attribute of the old name is
    the method.
    """
    notes: list[str] = []
    holders: dict[str, set[tuple[str, str]]] = {}
    for module, source in modules.items():
        for owner, name in _attributes_of_classes(source.tree):
            holders.setdefault(name, set()).add((module, owner))
    wanted: dict[str, dict[tuple[str, str], str]] = {}
    for (module, owner, name), new in methods.items():
        if (module, owner) in holders.get(name, set()):
            wanted.setdefault(name, {})[module, owner] = new
        else:
            notes.append(f"{module}:{owner} has no {name}")
    result: dict[str, Renaming] = {}
    for name, owners in wanted.items():
        named = {key: new for key, new in owners.items() if " in " in new}
        for (module, _owner), new in named.items():
            new, _, files = new.partition(" in ")
            renaming = result.setdefault(name, Renaming())
            for file in [module, *files.split()]:
                if renaming.inside.setdefault(file, new) != new:
                    notes.append(f"methods {name}: two new names in {file}")
        rest = {key: new for key, new in owners.items() if key not in named}
        others = holders[name] - set(owners)
        taken = {new for key, new in rest.items() if key in holders.get(new, set())}
        if taken:
            notes.append(f"methods {name}: not renamed, {sorted(taken)} is there already")
        elif rest and not named and not others and len(set(rest.values())) == 1:
            result[name] = Renaming(everywhere=next(iter(rest.values())))
        elif name.startswith("_"):
            for module in sorted({module for module, _owner in rest}):
                here = {new for key, new in rest.items() if key[0] == module}
                strangers = {owner for holder, owner in others if holder == module}
                if len(here) == 1 and not strangers:
                    result.setdefault(name, Renaming()).inside[module] = next(iter(here))
                else:
                    notes.append(f"methods {name}: not renamed in {module}, {sorted(strangers | here)}")
        elif rest:
            where = ", ".join(sorted(f"{module}:{owner}" for module, owner in others))
            notes.append(
                f"methods {name}: not renamed, {sorted(set(rest.values()))}; an attribute of {where} too"
            )
    return result, notes


def attributes(
    source: Source, renamings: Mapping[str, Renaming], is_module: Callable[[Source, str], bool]
) -> Iterator[Edit]:
    """New names where methods are defined, used as attributes or named in `setattr` and its like."""
    here = {name: new for name, one in renamings.items() if (new := one.new(source))}
    if not here:
        return
    text, names = source.code, source.names
    formatted = [names.span(node) for node in ast.walk(source.tree) if isinstance(node, ast.JoinedStr)]
    for node in ast.walk(source.tree):
        if isinstance(node, ast.ClassDef) and source.module:
            for statement in node.body:
                if isinstance(statement, Functions) and statement.name in here:
                    start = re.compile(rf"def\s+({statement.name})\b").search(text, names.span(statement)[0])
                    assert start is not None
                    yield Edit(start.start(1), start.end(1), here[statement.name])
                elif isinstance(statement, ast.Assign | ast.AnnAssign):
                    targets = statement.targets if isinstance(statement, ast.Assign) else [statement.target]
                    for target in targets:
                        if isinstance(target, ast.Name) and target.id in here:
                            yield Edit(*names.span(target), here[target.id])
        elif isinstance(node, ast.Attribute) and node.attr in here:
            if isinstance(node.value, ast.Name) and is_module(source, node.value.id):
                continue
            around = [span for span in formatted if span[0] <= names.span(node)[0] < span[1]]
            if around:
                # the parts of a formatted string have no exact places before Python 3.12
                pattern = re.compile(rf"(?<=\.){node.attr}\b")
                for match in pattern.finditer(text, around[0][0], around[0][1]):
                    yield Edit(match.start(), match.end(), here[node.attr])
            else:
                end = names.span(node)[1]
                yield Edit(end - len(node.attr), end, here[node.attr])
        elif isinstance(node, ast.Call) and len(node.args) > 1:
            second = node.args[1]
            if (
                (
                    (isinstance(node.func, ast.Name) and node.func.id in ("getattr", "setattr", "hasattr"))
                    or (isinstance(node.func, ast.Attribute) and node.func.attr in ("setattr", "delattr"))
                )
                and isinstance(second, ast.Constant)
                and second.value in here
            ):
                if isinstance(node.args[0], ast.Name) and is_module(source, node.args[0].id):
                    continue
                first, last = names.span(second)
                yield Edit(first + 1, last - 1, here[second.value])


def _attributes_of_classes(tree: ast.Module) -> Iterator[tuple[str, str]]:
    """(class, name) of methods, fields and what methods assign to `self`."""
    for node in ast.walk(tree):
        if not isinstance(node, ast.ClassDef):
            continue
        for inner in node.body:
            if isinstance(inner, Functions):
                yield node.name, inner.name
                for part in ast.walk(inner):
                    if (
                        isinstance(part, ast.Attribute)
                        and isinstance(part.ctx, ast.Store)
                        and isinstance(part.value, ast.Name)
                        and part.value.id == "self"
                    ):
                        yield node.name, part.attr
            elif isinstance(inner, ast.AnnAssign) and isinstance(inner.target, ast.Name):
                yield node.name, inner.target.id
            elif isinstance(inner, ast.Assign):
                for target in inner.targets:
                    if isinstance(target, ast.Name):
                        yield node.name, target.id
