"""The JSON Schema: its keys are the grammar's, and what the reader accepts it accepts."""

import json
import tomllib
from pathlib import Path
from typing import Any

import pytest

import centrode.model.examples as examples
from centrode.model.files import mechanism_text, parse_mechanism
from centrode.model.schema import PROPERTIES, mechanism_schema

from .conftest import FOUR_BAR, FULL, SPHERE

EXAMPLES = sorted(Path(examples.__path__[0]).glob("*.toml"))
TYPES = {
    "object": dict,
    "array": list,
    "string": str,
    "number": (int, float),
    "integer": int,
    "boolean": bool,
}


def fits(value: Any, schema: dict[str, Any] | bool, whole: dict[str, Any]) -> bool:
    """A light reading of the schema's own words; enough for the words it uses."""
    if isinstance(schema, bool):
        return schema
    if "$ref" in schema:
        return fits(value, whole["$defs"][schema["$ref"].removeprefix("#/$defs/")], whole)
    if "anyOf" in schema:
        return any(fits(value, other, whole) for other in schema["anyOf"])
    if "enum" in schema or "const" in schema:
        return value in schema.get("enum", [schema.get("const")])
    if isinstance(value, bool) or schema["type"] == "boolean":
        return isinstance(value, bool) and schema["type"] == "boolean"
    if not isinstance(value, TYPES[schema["type"]]):
        return False
    if isinstance(value, dict):
        known = schema.get("properties", {})
        other = schema.get("additionalProperties", True)
        return set(schema.get("required", [])) <= set(value) and all(
            fits(entry, known[key], whole) if key in known else other and fits(entry, other, whole)
            for key, entry in value.items()
        )
    if isinstance(value, list):
        length = schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", len(value))
        return length and all(fits(entry, schema["items"], whole) for entry in value)
    if isinstance(value, str):
        return schema.get("minLength", 0) <= len(value) <= schema.get("maxLength", len(value))
    return value > schema.get("exclusiveMinimum", -float("inf")) and value >= schema.get(
        "minimum", -float("inf")
    )


def test_keys_are_those_of_the_parts() -> None:
    for part, properties in PROPERTIES.items():
        assert list(properties) == list(part.keys()), part


def test_schema_is_plain_json() -> None:
    schema = mechanism_schema()
    assert json.loads(json.dumps(schema)) == schema
    assert schema["required"] == ["links"]


@pytest.mark.parametrize("text", [FULL, SPHERE, FOUR_BAR])
def test_the_grammar_fits(text: str) -> None:
    schema = mechanism_schema()
    assert fits(tomllib.loads(text), schema, schema)
    assert fits(tomllib.loads(mechanism_text(parse_mechanism(text))), schema, schema)


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_built_in_examples_fit(path: Path) -> None:
    schema = mechanism_schema()
    assert fits(tomllib.loads(path.read_text(encoding="utf-8")), schema, schema)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("length = 3.5", "lenght = 3.5"),
        ("length = 3.5", "length = -1"),
        ("length = 3.5", "length = true"),
        ("O = [0, 0]", "O = [0]"),
        ("O = [0, 0]", 'O = "somewhere"'),
        ("[[drives]]", "[drives]"),
    ],
)
def test_what_is_no_description_does_not_fit(old: str, new: str) -> None:
    schema = mechanism_schema()
    assert not fits(tomllib.loads(FOUR_BAR.replace(old, new)), schema, schema)
