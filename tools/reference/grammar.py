"""The page of the grammar: every key of a description with its permitted values, from the JSON Schema."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeAlias

from centrode.model.schema import cam_schema, mechanism_schema

Schema: TypeAlias = dict[str, Any]

HEAD = """# Grammar of {things}

Every key with its permitted values, made from the schema that also reads the files (`centrode schema`).
The keys are explained in {meaning}.
Files are TOML. A number is in SI (m, kg, s, rad, N); a text has a unit: `"28.6 deg"`, `"0.5 mm"`. Other keys are
refused.
"""
FILES = {"Cam": "A cam from a curvature law", "PlateCam": "A plate cam under its follower"}
FIRST_OF_LOADS = "Load"
"""Part with which the second page of linkages begins."""
NAME = 40
"""Letters of the longest name."""
WORDS = {
    "number": "number", "integer": "whole number", "boolean": "`true` or `false`", "object": "table", "null": "nothing",
}  # fmt: skip


def mechanisms() -> dict[str, str]:
    """The two pages of linkages as Markdown: what moves; loads, machines and what is wanted of them."""
    schema = mechanism_schema()
    names = list(schema["$defs"])
    first = names.index(FIRST_OF_LOADS)
    shares = {"grammar": names[:first], "grammar-of-loads": names[first:]}
    meaning = "[the description](../description.md)"
    heads = {
        "grammar": HEAD.format(things="mechanisms", meaning=meaning) + "\n## The file\n\n" + _table(schema),
        "grammar-of-loads": HEAD.format(things="loads, machines and studies", meaning=meaning),
    }
    return {page: _page(heads[page], schema, parts, page, shares) for page, parts in shares.items()}


def cams() -> str:
    """The page of cams as Markdown: each kind of file, then their parts."""
    schema = cam_schema()
    meaning = "[Cams from a curvature law](../cams.md),\nfor plate cams in [Motion of a follower](../cam-followers.md)"
    files = [one["$ref"].rpartition("/")[2] for one in schema["anyOf"]]
    parts = {name: part for name, part in schema["$defs"].items() if name not in files}
    tables = [f"## {FILES[name]}\n\n{_table(schema['$defs'][name])}" for name in files]
    head = HEAD.format(things="cams", meaning=meaning)
    return "\n".join([head, *tables, *(_part(name, inner, schema) for name, inner in parts.items())])


def _page(head: str, schema: Schema, names: list[str], page: str, shares: Mapping[str, list[str]]) -> str:
    """A page with some of the parts; links to parts of another page lead there."""
    text = "\n".join([head, *(_part(name, schema["$defs"][name], schema) for name in names)])
    for other, parts in shares.items():
        for name in parts if other != page else ():
            text = text.replace(f"](#{name.lower()})", f"]({other}.md#{name.lower()})")
    return text


def _part(name: str, inner: Schema, whole: Schema) -> str:
    places = ", ".join(f"`{place}`" for place in _places(name, whole))
    return f"## {name}\n\nPlace: {places}.\n\n{_table(inner)}"


def _places(name: str, whole: Schema) -> list[str]:
    """Keys below which a part belongs, as TOML spells them."""
    reference = f"#/$defs/{name}"
    found = []
    for owner, schema in (("", whole), *whole["$defs"].items()):
        for key, value in schema.get("properties", {}).items():
            spelled = {"array": f"[[{key}]]", "object": f"[{key}.NAME]"}.get(
                value.get("type", ""), f"[{key}]"
            )
            if reference in _references(value):
                found.append(spelled if owner in ("", *FILES) else f"{key} of {owner}")
    return list(dict.fromkeys(found))


def _references(schema: Any) -> set[str]:
    if isinstance(schema, dict):
        own = {schema["$ref"]} if "$ref" in schema else set()
        return own.union(*(_references(value) for value in schema.values()))
    if isinstance(schema, list):
        return set().union(*(_references(value) for value in schema))
    return set()


def _table(schema: Schema) -> str:
    required = set(schema.get("required", ()))
    rows = ["| key | permitted values |", "|---|---|"]
    for key, value in schema.get("properties", {}).items():
        must = " (needed)" if key in required else ""
        rows.append(f"| `{key}`{must} | {_said(value)} |")
    return "\n".join(rows) + "\n"


def _said(schema: Schema) -> str:
    """What a value may be, in words."""
    if "$ref" in schema:
        part = schema["$ref"].rpartition("/")[2]
        return f"a table, [{part}](#{part.lower()})"
    if "const" in schema:
        return f"`{_spelled(schema['const'])}`"
    if "enum" in schema:
        return " or ".join(f"`{_spelled(word)}`" for word in schema["enum"])
    if "description" in schema:
        return f"{schema['description']}{_bounds(schema)}"
    if "anyOf" in schema:
        return "; or ".join(dict.fromkeys(_said(one) for one in schema["anyOf"]))
    return _by_type(schema)


def _spelled(word: Any) -> str:
    return f'"{word}"' if isinstance(word, str) else str(word).lower()


def _by_type(schema: Schema) -> str:
    kind = schema.get("type", "")
    if kind == "array":
        return _list(schema)
    if kind == "object" and isinstance(schema.get("additionalProperties"), dict):
        most = f" (at most {schema['maxProperties']})" if "maxProperties" in schema else ""
        return f"names{most}, each with {_said(schema['additionalProperties'])}"
    if kind == "string":
        letters = schema.get("maxLength")
        if letters is None:
            return "a text"
        return "a name" if letters == NAME else f"a text of at most {letters} letters"
    word = WORDS[kind]
    return (word if kind in ("boolean", "null") else f"a {word}") + _bounds(schema)


def _list(schema: Schema) -> str:
    """A list: of tables, which TOML writes one by one, or of values."""
    count, items = _count(schema, "minItems", "maxItems"), schema["items"]
    if "$ref" in items:
        part = items["$ref"].rpartition("/")[2]
        return f"{count} tables, [{part}](#{part.lower()})"
    if _said(items) in ("a name", "a number"):
        return f"a list of {count} {_said(items).removeprefix('a ')}s"
    return f"a list of {count}, each {_said(items)}"


def _count(schema: Schema, least: str, most: str) -> str:
    low, high = schema.get(least, 0), schema.get(most)
    if low == high:
        return str(low)
    if high is None:
        return f"{low} or more"
    return f"{low} to {high}" if low else f"up to {high}"


def _bounds(schema: Schema) -> str:
    """Limits of a number, told behind it."""
    numbers = [schema, *schema.get("anyOf", ())]
    found = []
    for one in numbers:
        if "exclusiveMinimum" in one:
            found.append(f"above {one['exclusiveMinimum']:g}")
        if "minimum" in one:
            found.append(f"at least {one['minimum']:g}")
        if "maximum" in one:
            found.append(f"at most {one['maximum']:g}")
    return f"; {', '.join(dict.fromkeys(found))}" if found else ""
