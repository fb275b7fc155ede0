"""What every part of a description is: frozen data that names what it does not know."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import islice
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel, ConfigDict, ValidationError, model_validator

from centrode.locale import _
from centrode.model import limits
from centrode.model.problems import Problem, Problems, input_error, nearest, shown

if TYPE_CHECKING:
    from pydantic._internal._model_construction import ModelMetaclass
else:
    ModelMetaclass = type(BaseModel)  # its name is private to pydantic


class _Telling(ModelMetaclass):
    """Makes a wrong value given in Python an InputError; parts inside parts are gathered by pydantic first."""

    def __call__(cls, *args: Any, **values: Any) -> Any:  # noqa: N805
        try:
            return super().__call__(*args, **values)
        except ValidationError as error:
            raise input_error(error, "") from None


class Part(BaseModel, metaclass=_Telling):
    """Frozen data with known keys only; a wrong value raises InputError."""

    model_config = ConfigDict(
        frozen=True,
        extra="forbid",
        validate_by_name=True,
        validate_by_alias=True,
        arbitrary_types_allowed=True,
    )

    @classmethod
    def keys(cls) -> dict[str, str]:
        """Field of each key, the key as the file spells it."""
        return {field.alias or name: name for name, field in cls.model_fields.items()}

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        """What is wrong with the keys that are given; a part adds its own rules."""
        keys = cls.keys()
        known = {**keys, **{name: name for name in cls.model_fields}}
        unknown = [
            Problem(_("unknown key {key}").format(key=shown(key)), nearest(str(key), keys))
            for key in islice((key for key in given if key not in known), limits.PROBLEMS_SOUGHT)
        ]
        missing = [
            missing_key(key)
            for key, name in keys.items()
            if cls.model_fields[name].is_required() and key not in given and name not in given
        ]
        return unknown + missing

    @model_validator(mode="before")
    @classmethod
    def _keys_known(cls, data: Any) -> Any:
        if isinstance(data, cls):
            return data
        if not isinstance(data, Mapping):
            raise Problem(_("expected a table, got {value}").format(value=shown(data)))
        problems = cls.key_problems(data)
        if problems:
            raise Problems(problems)
        return dict(data)


def missing_key(key: str) -> Problem:
    """The problem of a key that has to be given."""
    return Problem(_("{key} is missing").format(key=shown(key)))


def one_of(given: Mapping[str, Any], keys: tuple[str, ...]) -> list[Problem]:
    """The problem, if any, of not giving exactly one of `keys`."""
    names = [key for key in keys if given.get(key) is not None]
    if len(names) == 1:
        return []
    words = ", ".join(keys)
    if not names:
        return [Problem(_("one of {keys} is missing").format(keys=words))]
    return [Problem(_("{names} are given together").format(names=", ".join(names)), _("keep one of them"))]
