"""The moves of a table over a repository: new texts of all files that change."""

from __future__ import annotations

import ast
import copy
import re
import textwrap
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

from tools.moves.methods import agreed, attributes
from tools.moves.scopes import Imported, Member, Occurrence, Scope
from tools.moves.sources import SOURCE, Edit, Source, Unresolved, edited
from tools.moves.table import PACKAGE, Table, dotted

WIDTH = 110
Key = tuple[str, ...]


@dataclass(frozen=True)
class Target:
    """What an import of the package means: a module, or a name that a module defines."""

    module: str
    name: str | None = None


@dataclass(frozen=True, order=True)
class Line:
    """An import of one name: `from module import name as local`, or `import name as local` without a module."""

    module: str
    name: str
    local: str

    def __str__(self) -> str:
        binding = self.name if self.local == self.name else f"{self.name} as {self.local}"
        return f"from {self.module} import {binding}" if self.module else f"import {binding}"


@dataclass
class Plan:
    """What becomes of the names of one source.

    Attributes
    ----------
    changes : (scope, name) -> new name
    inner : (scope, name) -> old module
        Names of modules that become part of the same new one.
    outer : (scope, name) -> old module
        Names of other modules.
    lines : statement -> its imports, new
    changed : statements whose imports change
    keys : name of the module -> what it means
    dropped : definitions that another part has in the same words
    """

    source: Source
    here: str | None
    changes: dict[tuple[Scope, str], str] = field(default_factory=dict)
    inner: dict[tuple[Scope, str], str] = field(default_factory=dict)
    outer: dict[tuple[Scope, str], str] = field(default_factory=dict)
    lines: dict[ast.stmt, list[tuple[Line, bool]]] = field(default_factory=dict)
    changed: set[ast.stmt] = field(default_factory=set)
    keys: dict[str, Key] = field(default_factory=dict)
    dropped: set[str] = field(default_factory=set)

    def final(self, name: str) -> str:
        """New name of a name of the module."""
        return self.changes.get((self.source.names.module, name), name)


class Moves:
    """The moves of one table: `texts` has the new files, `gone` the old ones, `questions` what stays open."""

    def __init__(self, table: Table, sources: Mapping[Path, Source]) -> None:
        self.table = table
        self.sources = sources
        self.modules = {source.module: source for source in sources.values() if source.module}
        self.questions: list[str] = []
        self.notes: list[str] = []
        self.parts: dict[str, list[str]] = {}
        self.new_modules: dict[str, str] = {}
        for new, olds in table.modules.items():
            for old in olds:
                name = dotted(old)
                if name not in self.modules:
                    self.notes.append(f"{old} (for {new}) is not there")
                elif name in self.new_modules:
                    self.questions.append(f"{old} is named twice")
                else:
                    self.new_modules[name] = dotted(new)
                    self.parts.setdefault(dotted(new), []).append(name)
        for name in self.modules:
            if name not in self.new_modules:
                new = self._in_moved_folder(name)
                if new != name:
                    self.new_modules[name] = new
                    self.parts.setdefault(new, []).append(name)
        for new in self.parts:
            if new in self.modules and new not in self.parts[new] and new not in self.new_modules:
                self.questions.append(f"{new} is there already and not in the table")
        for module, name in table.names:
            if module not in self.modules:
                self.notes.append(f"{module} (for {name}) is not there")
            elif name not in self.modules[module].names.module.bound:
                self.notes.append(f"{module} has no {name}")
        for (module, name), new in table.names.items():
            source = self.modules.get(module)
            if source and name in source.definitions and module not in self.new_modules:
                taken = new in source.names.module.bound and (module, new) not in table.names
                if taken:
                    self.questions.append(f"{module}: {new} (for {name}) is there already")
        self.methods, notes = agreed(table.methods, self.modules)
        self.notes += notes
        self._relevant = self._mention()
        self.plans = {
            path: self._plan(source) for path, source in sources.items() if self._is_touched(source)
        }
        self.by_module = {plan.source.module: plan for plan in self.plans.values() if plan.source.module}
        for new in self.parts:
            self._collisions(new)

    # -- where things go

    def _in_moved_folder(self, module: str) -> str:
        for old, new in self.table.folders.items():
            if Path(old).is_relative_to(SOURCE):
                before, after = (dotted("/".join(Path(p).relative_to(SOURCE).parts)) for p in (old, new))
                if module == before or module.startswith(f"{before}."):
                    return after + module.removeprefix(before)
        return module

    def new_module(self, module: str) -> str:
        """New name of a module or package."""
        return self.new_modules.get(module) or self._in_moved_folder(module)

    def new_name(self, module: str, name: str) -> str:
        """New name of a definition, or of a name that a module imports and passes on."""
        holder = self.modules.get(module)
        if (module, name) in self.table.names or holder is None or name in holder.definitions:
            return self.table.names.get((module, name), name)
        for imported in holder.names.imports:
            if imported.local == imported.alias.name == name and imported.scope is holder.names.module:
                target = self.target(holder, imported)
                if target is not None and target.name is not None:
                    return self.new_name(target.module, target.name)
        return name

    def _mention(self) -> re.Pattern[str]:
        """What every file mentions that has anything to do with the moves."""
        rooms = {module.split(".")[1] for module in self.new_modules}
        rooms |= {module.split(".")[1] for module, _name in self.table.names}
        classes = {name for _module, name in self.table.names if name[:1].isupper()}
        return re.compile(rf"\b(?:{'|'.join(map(re.escape, sorted(rooms | classes)))})\b")

    def _is_touched(self, source: Source) -> bool:
        code = source.is_python or (source.path.suffix == ".md" and PACKAGE in source.text)
        named = any(re.search(rf"\b{method}\b", source.text) for method in self.methods)
        ours = {*self.new_modules, *(module for module, _name in self.table.names)}
        # a stub names the modules of its own room without the room
        stub = source.path.suffix == ".pyi" and bool(self._relevant.search(source.package))
        return code and (source.module in ours or named or stub or bool(self._relevant.search(source.text)))

    def target(self, source: Source, imported: Imported) -> Target | None:
        """What an import means; None if it is not of the package."""
        statement = imported.statement
        if isinstance(statement, ast.Import):
            known = imported.alias.asname and imported.alias.name in self.modules
            return Target(imported.alias.name) if known else None
        base = absolute(source, statement)
        return self.defined(base, imported.alias.name)

    def defined(self, module: str, name: str) -> Target | None:
        """The definition that a name of a module means, followed through modules that move."""
        inside = f"{module}.{name}"
        holder = self.modules.get(module)
        stub = self._ceasing_face(module)
        if stub is not None and inside not in self.modules:
            for imported in stub.names.imports:
                if imported.local == name:
                    return self.target(stub, imported)
        if holder is None:
            return Target(inside) if inside in self.modules else None
        if name in holder.definitions or name not in holder.names.module.bound:
            return Target(inside) if inside in self.modules else Target(module, name)
        if self.new_modules.get(module, module) == module and len(self.parts.get(module, [""])) == 1:
            return Target(module, name)
        for imported in holder.names.imports:
            if imported.local == name and imported.scope is holder.names.module:
                further = self.target(holder, imported)
                return further or Target(module, name)
        return Target(module, name)

    def _ceasing_face(self, module: str) -> Source | None:
        """The stub that lists what a room passes on, where the room ceases."""
        stub = SOURCE.joinpath(*module.split(".")[1:]) / "__init__.pyi"
        return self.sources.get(stub) if str(stub) in self.table.gone else None

    # -- names of one source

    def _plan(self, source: Source) -> Plan:
        plan = Plan(source, self.new_module(source.module) if source.module else None)
        names = source.names
        explicit = self.table.names
        for name in source.definitions:
            if source.module:
                plan.keys[name] = ("definition", source.module, name)
                if (source.module, name) in explicit:
                    plan.changes[names.module, name] = explicit[source.module, name]
        for (module, function, name), new in self.table.locals.items():
            if module == source.module:
                scopes = [scope for scope in names.scopes() if scope.path == function and name in scope.bound]
                if not scopes:
                    self.notes.append(f"{module}:{function} has no {name}")
                for scope in scopes:
                    plan.changes[scope, name] = new
        for imported in names.imports:
            self._plan_import(plan, imported)
        return plan

    def _plan_import(self, plan: Plan, imported: Imported) -> None:
        source, statement, local = plan.source, imported.statement, imported.local
        at = (imported.scope, local)
        target = self.target(source, imported)
        lines = plan.lines.setdefault(statement, [])
        chosen = self.table.names.get((source.module, local)) if source.module else None
        if target is None:
            module = absolute(source, statement) if isinstance(statement, ast.ImportFrom) else ""
            name = imported.alias.name
            bound = imported.alias.asname or name
            meaning = name if module or imported.alias.asname else name.split(".")[0]
            if chosen:
                plan.changes[at] = bound = chosen
                plan.changed.add(statement)
            lines.append((Line(module, name, bound), imported.typing_only))
            key: Key = ("outside", module, meaning)
        elif target.name is None:
            new = self.new_module(target.module)
            if self._ceasing_face(target.module) is not None:
                where = source.line(source.names.span(statement)[0])
                self.questions.append(f"{target.module} ceases and is imported at {where}")
            key = ("module", new)
            if new == plan.here and source.module:
                plan.inner[at] = target.module
                plan.changed.add(statement)
                key = ()
            else:
                package, _, last = new.rpartition(".")
                wanted = chosen or imported.alias.asname or last
                if wanted != local and not chosen and not self._is_free(plan, imported, wanted, target):
                    wanted = f"{package.rpartition('.')[2]}_{last}"
                plan.outer[at] = target.module
                plan.changes[at] = wanted
                lines.append((Line(package, last, wanted), imported.typing_only))
                if new != target.module or wanted != local:
                    plan.changed.add(statement)
        else:
            new, name = self.new_module(target.module), self.new_name(target.module, target.name)
            key = ("definition", target.module, target.name)
            if new == plan.here and source.module:
                plan.changes[at] = name
                plan.changed.add(statement)
            else:
                wanted = chosen or imported.alias.asname or name
                if imported.alias.asname == imported.alias.name:
                    wanted = name  # `x as x` of a stub
                if wanted != local and not chosen and not self._is_free(plan, imported, wanted, target):
                    wanted = local
                plan.changes[at] = wanted
                lines.append((Line(new, name, wanted), imported.typing_only))
                base = absolute(source, statement) if isinstance(statement, ast.ImportFrom) else ""
                if (new, name, wanted) != (base, imported.alias.name, local):
                    plan.changed.add(statement)
        if imported.scope is source.names.module and key:
            plan.keys[local] = key

    def _is_free(self, plan: Plan, imported: Imported, wanted: str, target: Target) -> bool:
        scope, names = imported.scope, plan.source.names
        if wanted in scope.bound:
            others = [other for other in names.imports if other.local == wanted and other.scope is scope]
            meanings = [self.target(plan.source, other) for other in others]
            same = [
                meaning is not None
                and meaning.name == target.name
                and self.new_module(meaning.module) == self.new_module(target.module)
                for meaning in meanings
            ]
            if not others or not all(same) or wanted in plan.source.definitions:
                return False
        for occurrence in names.occurrences:
            is_used = occurrence.name == imported.local and occurrence.scope.resolve(occurrence.name) is scope
            if is_used and occurrence.scope.resolve(wanted) not in (None, scope):
                return False
            if occurrence.name == wanted and occurrence.scope.resolve(wanted) is None:
                return False  # a builtin
        return True

    # -- several parts in one module

    def _collisions(self, new: str) -> None:
        plans = [self.by_module[old] for old in self.ordered(new)]
        if len(plans) == 1:
            return
        holders: dict[str, list[tuple[Plan, str]]] = {}
        for plan in plans:
            for name in plan.keys:
                if name not in ("__all__", "annotations", "TYPE_CHECKING"):
                    holders.setdefault(plan.final(name), []).append((plan, name))
        for final, held in sorted(holders.items()):
            first, first_name = held[0]
            for plan, name in held[1:]:
                if plan.keys[name] == first.keys[first_name]:
                    continue
                if self._are_alike(first.keys[first_name], plan.keys[name]):
                    plan.dropped.add(name)
                    continue
                where = ", ".join(f"{p.source.module}:{n} ({' '.join(p.keys[n])})" for p, n in held)
                self.questions.append(f"{new}: {final} means several things: {where}")
                break
        captured = set(holders)
        for plan in plans:
            for occurrence in plan.source.names.occurrences:
                if occurrence.scope.resolve(occurrence.name) is None and occurrence.name in captured:
                    where = plan.source.line(occurrence.start)
                    self.questions.append(f"{new}: {occurrence.name} is a builtin at {where}")

    def _are_alike(self, one: Key | None, other: Key | None) -> bool:
        """Whether two definitions are the same words with the same meanings."""
        if one == other:
            return True
        if not one or not other or one[0] != "definition" or other[0] != "definition":
            return False
        values = self._value(*one[1:]), self._value(*other[1:])
        if None not in values:
            return values[0] == values[1]
        if one[2] != other[2]:
            return False
        first, second = (
            self.modules[one[1]].definitions.get(one[2]),
            self.modules[other[1]].definitions.get(other[2]),
        )
        if not first or not second or [ast.dump(s) for s in first] != [ast.dump(s) for s in second]:
            return False
        used = {node.id for statement in first for node in ast.walk(statement) if isinstance(node, ast.Name)}
        return all(
            self._are_alike(self._key(one[1], name), self._key(other[1], name)) for name in used - {one[2]}
        )

    def _value(self, module: str, name: str) -> str | None:
        """The value of an alias or a constant, with every name in it spelled out; None of anything else."""
        key = self._key(module, name)
        if key is None:
            return name
        if key[0] != "definition":
            return ".".join(part for part in key[1:] if part)
        if key[1:] != (module, name):
            return self._value(*key[1:])
        statements = self.modules[module].definitions[name]
        statement = statements[0]
        if (
            len(statements) > 1
            or not isinstance(statement, ast.Assign | ast.AnnAssign)
            or statement.value is None
        ):
            return None
        kinds = (ast.Constant, ast.Name, ast.Attribute, ast.Subscript, ast.Tuple, ast.expr_context)
        if not all(isinstance(node, kinds) for node in ast.walk(statement.value)):
            return None
        value = copy.deepcopy(statement.value)
        for node in ast.walk(value):
            if isinstance(node, ast.Name):
                key = self._key(module, node.id)
                node.id = self._value(module, node.id) or ".".join(key[1:] if key else (node.id,))
        return ast.unparse(value)

    def _key(self, module: str, name: str) -> Key | None:
        """What a name of a module means there."""
        source = self.modules[module]
        if name in source.definitions:
            return ("definition", module, name)
        for imported in source.names.imports:
            if imported.local == name and imported.scope is source.names.module:
                target = self.target(source, imported)
                if target is None:
                    base = (
                        absolute(source, imported.statement)
                        if isinstance(imported.statement, ast.ImportFrom)
                        else ""
                    )
                    return ("outside", base, imported.alias.name)
                return (
                    ("definition", target.module, target.name) if target.name else ("module", target.module)
                )
        return None

    def ordered(self, new: str) -> list[str]:
        """Parts of a new module so that definitions stand before what imports them, else as the table has them."""
        parts = self.parts[new]
        needs: dict[str, set[str]] = {part: set() for part in parts}
        for part in parts:
            plan = self.by_module[part]
            for imported in plan.source.names.imports:
                target = self.target(plan.source, imported)
                if target is not None and target.module in set(needs) - {part} and not imported.typing_only:
                    needs[part].add(target.module)
        try:
            list(TopologicalSorter(needs).static_order())
        except CycleError as error:
            raise Unresolved(f"{new}: its parts import each other: {error.args[1]}") from None
        done: list[str] = []
        while len(done) < len(parts):
            done.append(next(part for part in parts if part not in done and needs[part] <= set(done)))
        return done

    def circles(self) -> list[list[str]]:
        """Modules that would import each other as they are loaded."""
        needs: dict[str, set[str]] = {}
        for source in self.modules.values():
            plan = self.by_module.get(source.module or "")
            here = self.new_module(source.module or "")
            found = needs.setdefault(here, set())
            if plan:
                for statement, lines in plan.lines.items():
                    if statement in source.tree.body:
                        found |= {f"{line.module}.{line.name}" for line, _t in lines}
                        found |= {line.module for line, _t in lines}
            else:
                for match in re.finditer(r"(?m)^from (centrode[\w.]*) import ([^(\n]+)", source.text):
                    found.add(match[1])
                    found |= {f"{match[1]}.{name.split()[0].rstrip(',')}" for name in match[2].split(",")}
                found |= set(re.findall(r"(?m)^from (centrode[\w.]*) import \(", source.text))
        graph = {here: (found & set(needs)) - {here, PACKAGE} for here, found in needs.items()}
        circles = []
        while True:
            try:
                list(TopologicalSorter(graph).static_order())
            except CycleError as error:
                circles.append(error.args[1])
                graph[error.args[1][1]] -= {error.args[1][0]}
            else:
                return circles

    # -- edits

    def edits(self, plan: Plan) -> list[Edit]:
        """All changes of a source's text but those of whole import statements."""
        methods = attributes(plan.source, self.methods, self._is_module)
        return [*self._renames(plan), *self._members(plan), *methods, *self._prose(plan)]

    def _is_module(self, source: Source, name: str) -> bool:
        """Whether a plain name is that of an imported module."""
        for imported in source.names.imports:
            if imported.local == name:
                target = self.target(source, imported)
                if target is None or target.name is None:
                    return True
        return False

    def _shadowed(self, plan: Plan, occurrence: Occurrence, new: str, until: Scope | None) -> None:
        scope: Scope | None = occurrence.scope
        while scope is not None and scope is not until:
            visible = scope.kind != "class" or scope is occurrence.scope
            bound = {plan.changes.get((scope, name), name) for name in scope.bound if name not in scope.outer}
            if visible and new in bound and scope.kind != "module":
                where = plan.source.line(occurrence.start)
                self.questions.append(f"{where}: {new} is a local name of {scope.path}")
                return
            scope = scope.parent

    def _renames(self, plan: Plan) -> Iterator[Edit]:
        for occurrence in plan.source.names.occurrences:
            scope = occurrence.scope.resolve(occurrence.name)
            if scope is None:
                continue
            new = plan.changes.get((scope, occurrence.name), occurrence.name)
            if new != occurrence.name:
                self._shadowed(plan, occurrence, new, scope)
                if occurrence.inside:
                    pattern = rf"(?<![\w.\"']){occurrence.name}(?![\w=\"'])"
                    yield from _in_braces(plan.source.text, occurrence.inside, pattern, new)
                else:
                    yield Edit(occurrence.start, occurrence.end, new)

    def _members(self, plan: Plan) -> Iterator[Edit]:
        owned: set[Occurrence] = set()
        for member in plan.source.names.members:
            owner = member.owner
            scope = owner.scope.resolve(owner.name)
            if scope is None:
                continue
            if (scope, owner.name) in plan.inner and not member.quoted:
                owned.add(owner)
                new = self._member(plan.inner[scope, owner.name], member, plan)
                self._shadowed(plan, owner, new, None)
                if owner.inside:
                    pattern = rf"(?<![\w.]){owner.name}\.{member.attribute}\b"
                    yield from _in_braces(plan.source.text, owner.inside, pattern, new)
                else:
                    yield Edit(owner.start, member.end, new)
            elif (scope, owner.name) in plan.outer:
                new = self._member(plan.outer[scope, owner.name], member, plan)
                if new != member.attribute and member.quoted:
                    yield Edit(member.start + 1, member.end - 1, new)
                elif new != member.attribute and owner.inside:
                    local = plan.changes.get((scope, owner.name), owner.name)
                    pattern = rf"(?<![\w.]){owner.name}\.{member.attribute}\b"
                    yield from _in_braces(plan.source.text, owner.inside, pattern, f"{local}.{new}")
                elif new != member.attribute:
                    yield Edit(member.start, member.end, new)
        for occurrence in plan.source.names.occurrences:
            scope = occurrence.scope.resolve(occurrence.name)
            if scope and (scope, occurrence.name) in plan.inner and occurrence not in owned:
                where = plan.source.line(occurrence.start)
                self.questions.append(f"{where}: the module {occurrence.name} is used as a value")

    def _member(self, module: str, member: Member, plan: Plan) -> str:
        holder = self.by_module.get(module)
        if holder is None or module not in self.new_modules:
            return holder.final(member.attribute) if holder else member.attribute
        if member.attribute not in holder.source.names.module.bound:
            inside = f"{module}.{member.attribute}"
            if inside not in self.modules and not member.quoted:
                where = plan.source.line(member.owner.start)
                self.notes.append(f"{where}: {module} has no {member.attribute}")
        return holder.final(member.attribute)

    # -- words

    def dotted_name(self, text: str) -> str:
        """A dotted name of a module, or of something in one, as it will be."""
        parts = text.split(".")
        for length in range(len(parts), 1, -1):
            module = ".".join(parts[:length])
            rest = parts[length:]
            if module in self.modules:
                if rest:
                    target = self.defined(module, rest[0])
                    if target and target.name:
                        rest = [self.new_name(target.module, target.name), *rest[1:]]
                        module = target.module
                return ".".join([self.new_module(module), *rest])
        return self._in_moved_folder(text)

    def dotted_names(self, text: str, in_code: bool) -> str:
        """Dotted names and paths in a text; without the package's own name only in backticks."""
        text = re.sub(rf"\b{PACKAGE}(?:\.\w+)+", lambda m: self.dotted_name(m[0]), text)

        def path(match: re.Match[str]) -> str:
            module = dotted(match[2])
            if module not in self.new_modules:
                return match[0]
            new = self.new_modules[module].removeprefix(f"{PACKAGE}.").replace(".", "/")
            return f"{match[1] or ''}{new}.py"

        text = re.sub(rf"(?<![\w/.])((?:src/)?{PACKAGE}/)?((?:\w+/)+\w+)\.py\b", path, text)
        for old, new in self.table.folders.items():
            text = re.sub(rf"(?<![\w/.]){re.escape(old)}(?![\w-])", new, text)
        if in_code:
            return text

        def short(match: re.Match[str]) -> str:
            before = f"{PACKAGE}.{match[1]}"
            return "`" + self.dotted_name(before).removeprefix(f"{PACKAGE}.")

        return re.sub(r"(?<!`)`((?!centrode\.)\w+(?:\.\w+)+)(?=[`(])", short, text)

    def _prose(self, plan: Plan) -> Iterator[Edit]:
        source = plan.source
        words = {
            name: new for (scope, name), new in plan.changes.items() if scope.kind == "module" and name != new
        }
        for name, renaming in self.methods.items():
            new_name = renaming.new(source)
            if new_name and name not in source.names.module.bound:
                words.setdefault(name, new_name)
        imports = [source.names.span(statement) for statement in plan.lines]
        for start, end, is_prose in source.prose():
            if any(a <= start < b for a, b in imports):
                continue
            old = source.text[start:end]
            new = self.dotted_names(old, not is_prose)
            if is_prose:
                new = _words(new, {**self._classes, **words} if source.is_python else self._classes)
            elif source.text[max(0, start - 9) : start].rstrip().endswith(("cast(", "Alias =")):
                # a type in quotes
                new = re.sub(r"\w+", lambda m: words.get(m[0], m[0]), new)
            if new != old:
                yield Edit(start, end, new)

    @cached_property
    def _class_counts(self) -> Counter[str]:
        return Counter(
            name for source in self.modules.values() for name in re.findall(r"(?m)^class (\w+)", source.text)
        )

    @cached_property
    def _classes(self) -> dict[str, str]:
        """Renamed classes whose old name the package has once."""
        found: dict[str, str] = {}
        for (module, name), new in self.table.names.items():
            source = self.modules.get(module)
            statements = source.definitions.get(name, []) if source else []
            if self._class_counts[name] == 1 and any(isinstance(s, ast.ClassDef) for s in statements):
                found[name] = new
        return found

    # -- files

    def results(self) -> tuple[dict[Path, str], set[Path]]:
        """New texts by their paths, and the paths that go."""
        texts: dict[Path, str] = {}
        gone: set[Path] = set()
        for path, source in self.sources.items():
            plan = self.plans.get(path)
            if str(path) in self.table.gone:
                gone.add(path)
                continue
            if source.module and source.module in self.new_modules:
                continue
            new_path = self._moved_file(path)
            text = self._rewritten(plan) if plan else self.dotted_names(source.text, True)
            if path == Path("pyproject.toml"):
                text = self._layers(source.text)
            for passage in self.table.texts:
                if Path(passage.file) in (path, new_path):
                    if passage.old not in text:
                        self.notes.append(f"{path}: no {passage.old!r}")
                    text = text.replace(passage.old, passage.new)
            if text != source.text or new_path != path:
                texts[new_path] = text
                gone |= {path} - {new_path}
        for new in self.parts:
            plans = [self.by_module[old] for old in self.ordered(new)]
            gone |= {plan.source.path for plan in plans}
            text = self._rewritten(plans[0]) if len(plans) == 1 else self._merged(new, plans)
            target = self._file(new, plans)
            for passage in self.table.texts:
                if Path(passage.file) == target:
                    if passage.old not in text:
                        self.notes.append(f"{target}: no {passage.old!r}")
                    text = text.replace(passage.old, passage.new)
            texts[target] = text
        for path in list(texts):
            if path.is_relative_to(SOURCE) and path.suffix == ".py":
                for folder in path.parents:
                    inner = folder / "__init__.py"
                    kept = inner in texts or (inner in self.sources and inner not in gone)
                    if folder.is_relative_to(SOURCE) and not kept:
                        texts[inner] = ""
        return texts, gone - set(texts)

    def _moved_file(self, path: Path) -> Path:
        for old, new in self.table.folders.items():
            if path.is_relative_to(old):
                return Path(new) / path.relative_to(old)
        return path

    def _file(self, module: str, plans: list[Plan]) -> Path:
        below = SOURCE.joinpath(*module.split(".")[1:])
        package = len(plans) == 1 and plans[0].source.path.name == "__init__.py"
        return below / "__init__.py" if package else below.with_suffix(".py")

    def _statement(self, plan: Plan, statement: ast.stmt) -> str:
        source = plan.source
        start = source.names.span(statement)[0]
        indent = " " * (start - source.text.rfind("\n", 0, start) - 1)
        lines = [line for line, _typing in plan.lines[statement]]
        relative = isinstance(statement, ast.ImportFrom) and statement.level
        if relative:
            lines = [
                Line(f".{line.module.removeprefix(source.package + '.')}", line.name, line.local)
                for line in lines
            ]
        groups: dict[str, list[Line]] = {}
        for line in lines:
            groups.setdefault(line.module, []).append(line)
        written = []
        for module, group in groups.items():
            stub = source.path.suffix == ".pyi"
            names = ", ".join(
                line.name if line.name == line.local and not stub else f"{line.name} as {line.local}"
                for line in group
            )
            written.append(f"from {module} import {names}" if module else f"import {names}")
        if not written:
            return "pass"
        return f"\n{indent}".join(written)

    def _rewritten(self, plan: Plan) -> str:
        edits = self.edits(plan)
        for statement in plan.changed:
            edits.append(Edit(*plan.source.names.span(statement), self._statement(plan, statement)))
        return edited(plan.source.text, edits)

    def _merged(self, new: str, plans: list[Plan]) -> str:
        main = self.by_module[self.parts[new][0]]
        runtime: set[Line] = set()
        typing_only: set[Line] = set()
        bodies = []
        doc = self.table.docstrings.get(new.removeprefix(f"{PACKAGE}.").replace(".", "/"))
        head = f'"""{doc.strip()}\n"""' if doc and "\n" in doc.strip() else f'"""{(doc or "").strip()}"""'
        for plan in plans:
            source, names = plan.source, plan.source.names
            edits = self.edits(plan)
            removed: list[ast.stmt] = []
            for statement in source.tree.body:
                if isinstance(statement, ast.Import | ast.ImportFrom) or _is_typing_block(statement):
                    removed.append(statement)
            for statement, lines in plan.lines.items():
                top = statement in removed or any(statement in ast.walk(block) for block in removed)
                if not top:
                    if statement in plan.changed:
                        edits.append(Edit(*names.span(statement), self._statement(plan, statement)))
                    continue
                for line, typing in lines:
                    if line.local in {plan.final(name) for name in plan.dropped}:
                        continue
                    (typing_only if typing else runtime).add(line)
            for name in (plan.dropped | {"__all__"}) & set(source.definitions):
                for statement in source.definitions[name]:
                    removed.append(statement)
                    after = source.tree.body[source.tree.body.index(statement) + 1 :]
                    if after and isinstance(after[0], ast.Expr) and isinstance(after[0].value, ast.Constant):
                        removed.append(after[0])
            doc_text = ""
            if source.docstring:
                span = names.span(source.docstring)
                doc_text = edited(source.text, edits, *span)
                removed.append(source.docstring)
                if plan is main and not doc:
                    head = doc_text
            kept = edits
            for statement in removed:
                first = names.starts[_first_line(statement) - 1]
                last = names.starts[(statement.end_lineno or 0)]
                kept = [e for e in kept if not (first <= e.start and e.end <= last)]
                kept.append(Edit(first, last, ""))
            body = edited(source.text, kept).strip("\n")
            if not body.strip():
                continue
            if doc_text and plan is not main:
                body = f"{_section(doc_text)}\n\n{body}"
            bodies.append(body)
        typing_only -= runtime
        parts = [head, "from __future__ import annotations"]
        imports = "\n".join(str(line) for line in sorted(runtime) if line.module != "__future__")
        parts.append(imports)
        if typing_only:
            parts.append("if TYPE_CHECKING:\n" + "\n".join(f"    {line}" for line in sorted(typing_only)))
        return "\n\n".join(part for part in parts if part) + "\n\n" + "\n\n\n".join(bodies) + "\n"

    def _layers(self, text: str) -> str:
        """Import contracts: dotted names, and layers that are named within their container."""
        blocks = re.split(r"(?m)^(?=\[\[)", text)
        return "".join(self._contract(block) for block in blocks)

    def _contract(self, block: str) -> str:
        container = re.search(r'containers = \["([\w.]+)"\]', block)
        seen: set[str] = set()
        lines = []
        in_list = ""
        for line in block.splitlines(keepends=True):
            opening = re.match(r"(\w+) = \[$", line.strip())
            in_list = opening[1] if opening else "" if line.strip() == "]" else in_list
            entry = re.fullmatch(r'(\s+)"([\w. |]+)",\n', line)
            if entry and in_list in ("layers", "source_modules", "forbidden_modules", "modules"):
                names = []
                for name in entry[2].split(" | "):
                    whole = f"{container[1]}.{name}" if container and in_list == "layers" else name
                    new = self.dotted_name(whole)
                    if container and in_list == "layers":
                        new = new.removeprefix(f"{self.dotted_name(container[1])}.")
                    if new not in seen:
                        names.append(new)
                        seen.add(new)
                if names:
                    lines.append(f'{entry[1]}"{" | ".join(names)}",\n')
            else:
                lines.append(self.dotted_names(line, True))
        return "".join(lines)


def absolute(source: Source, statement: ast.ImportFrom) -> str:
    """The module that a `from` names."""
    if not statement.level:
        return statement.module or ""
    base = source.package.split(".")
    base = base[: len(base) - statement.level + 1]
    return ".".join([*base, *([statement.module] if statement.module else [])])


def _is_typing_block(statement: ast.stmt) -> bool:
    return (
        isinstance(statement, ast.If)
        and isinstance(statement.test, ast.Name)
        and statement.test.id == "TYPE_CHECKING"
        and not statement.orelse
        and all(isinstance(inner, ast.Import | ast.ImportFrom | ast.Pass) for inner in statement.body)
    )


def _first_line(statement: ast.stmt) -> int:
    decorators: list[ast.expr] = getattr(statement, "decorator_list", [])
    return min([statement.lineno, *(decorator.lineno for decorator in decorators)])


def _section(docstring: str) -> str:
    """A docstring as a comment above the part that it stood over."""
    written = ast.literal_eval(docstring.strip())
    lines = []
    for line in (
        textwrap.dedent(written if written.startswith("\n") else " " * 0 + written).strip().splitlines()
    ):
        wrapped = textwrap.wrap(line, WIDTH - 2, break_long_words=False) or [""]
        lines += [f"# {part}".rstrip() for part in wrapped]
    return "\n".join(lines)


def _words(text: str, words: Mapping[str, str]) -> str:
    """Names in backticks, and types after a colon in a list of attributes, as they will be."""
    if not words:
        return text
    names = "|".join(sorted(map(re.escape, words), key=len, reverse=True))
    text = re.sub(rf"(?<!`)`({names})(?=[`.(])", lambda m: f"`{words[m[1]]}", text)
    return re.sub(
        r"(?m)^(\s+[\w, ]+ : )(.*)$",
        lambda m: m[1] + re.sub(rf"\b(?=[A-Z])({names})\b", lambda n: words[n[1]], m[2]),
        text,
    )


def _in_braces(text: str, span: tuple[int, int], pattern: str, new: str) -> Iterator[Edit]:
    """Matches in the fields of a formatted string."""
    start, end = span
    depth, field_start = 0, 0
    for at in range(start, end):
        if text[at] == "{":
            if depth == 0:
                field_start = at
            depth += 1
        elif text[at] == "}" and depth:
            depth -= 1
            if depth == 0:
                for match in re.compile(pattern).finditer(text, field_start + 1, at):
                    yield Edit(match.start(), match.end(), new)
