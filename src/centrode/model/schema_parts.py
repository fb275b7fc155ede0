"""What schemas of descriptions are made of: quantities, names, lists, tables, and the whole of one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from centrode.model import limits
from centrode.model.part import Part
from centrode.model.units import KINDS as QUANTITIES

Schema = dict[str, Any]


def quantity_schema(kind: str) -> Schema:
    """A number in SI, or a text with a unit."""
    named = QUANTITIES[kind]
    text = f"{named.name} in {named.unit}, or a text with a unit" if named.unit else named.name
    bounded = {"type": "string", "maxLength": limits.QUANTITY_LENGTH}
    return {"description": text, "anyOf": [{"type": "number"}, bounded]}


def above_zero(kind: str) -> Schema:
    """The same, positive where it is a number."""
    schema = quantity_schema(kind)
    schema["anyOf"][0] = {"type": "number", "exclusiveMinimum": 0}
    return schema


def list_of(item: Schema, least: int, most: int) -> Schema:
    """A list with bounds of its length."""
    return {"type": "array", "items": item, "minItems": least, "maxItems": most}


def table_of(entry: Schema, most: int) -> Schema:
    """A table of at most so many entries of one kind."""
    return {"type": "object", "additionalProperties": entry, "maxProperties": most}


def reference_to(part: type[Part]) -> Schema:
    """Where the schema of a part stands."""
    return {"$ref": f"#/$defs/{part.__name__}"}


NAME: Schema = {"type": "string", "minLength": 1, "maxLength": limits.NAME_LENGTH}
TEXT: Schema = {"type": "string", "maxLength": limits.TEXT_LENGTH}
AMOUNT: Schema = {
    "anyOf": [{"type": "number"}, TEXT],
    "description": "a number in SI, a text with a unit, a formula",
}


def schema_of(title: str, whole: type[Part], properties: Mapping[type[Part], Schema]) -> Schema:
    """JSON Schema of a file that one part describes, with the parts inside it as definitions."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": title,
        **_object(whole, properties),
        "$defs": {part.__name__: _object(part, properties) for part in properties if part is not whole},
    }


def _object(part: type[Part], properties: Mapping[type[Part], Schema]) -> Schema:
    required = [key for key, name in part.keys().items() if part.model_fields[name].is_required()]
    schema: Schema = {"type": "object", "properties": properties[part], "additionalProperties": False}
    return {**schema, "required": required} if required else schema
