"""Base class of the parts of a scenario; unknown keys raise an error that suggests the nearest key."""

from __future__ import annotations

from typing import Any, ClassVar, Self, get_args

from pydantic import (
    BaseModel,
    ConfigDict,
    ModelWrapValidatorHandler,
    ValidatorFunctionWrapHandler,
    WrapValidator,
    model_validator,
)

from onorbit_rs.common.suggestions import nearest
from onorbit_rs.scenario.errors import invalid, shortened
from onorbit_rs.scenario.unknown_keys import without_unknown_keys

FEW = 8
"""Largest number of known keys that a message lists in addition to the most similar key."""


class Part(BaseModel):
    """Base class of the parts of a scenario, each of which is a mapping in the YAML file."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)

    synonyms: ClassVar[dict[str, str]] = {}
    """Common alternative names of keys, for suggestions in messages."""

    @classmethod
    def yaml_keys(cls) -> list[str]:
        """Return the names that the keys of this part have in the YAML file."""
        return [field.alias or name for name, field in cls.model_fields.items()]

    @model_validator(mode="wrap")
    @classmethod
    def _refuse_unknown_keys(cls, value: Any, validate: ModelWrapValidatorHandler[Self]) -> Self:
        known = cls.yaml_keys()
        unknown = {}
        if isinstance(value, dict):
            free = [name for name in known if name not in value]
            unknown = {key: cls._hint(str(key), free) for key in value if key not in known}
        return without_unknown_keys(value, unknown, validate)

    @classmethod
    def _hint(cls, key: str, free: list[str]) -> str:
        """Return the end of the message about an unknown key, which suggests keys that are not given yet."""
        near = cls.synonyms.get(key.lower()) or nearest(key, free)
        known = [name for name in cls.yaml_keys() if name != "kind"]
        hint = f"; did you mean {near!r}?" if near else ""
        if hint and len(known) > FEW:
            return hint
        if not known:
            return "; this entry has no keys"
        return f"{hint}{' ' if hint else '; '}known keys: {', '.join(known)}"


def of_kind(union: Any) -> WrapValidator:
    """Return the validator of a union of parts that have a ``kind``; error messages list the kinds.

    A single word is a kind: ``gravity_gradient`` is equivalent to ``{kind: gravity_gradient}``.
    """
    parts = {get_args(part.model_fields["kind"].annotation)[0]: part for part in get_args(union)}
    keys = {kind: part.yaml_keys() for kind, part in parts.items()}
    kinds = ", ".join(keys)

    def read(value: Any, validate: ValidatorFunctionWrapHandler) -> Any:
        value = {"kind": value} if isinstance(value, str) else value
        if isinstance(value, Part):
            return validate(value)
        if not isinstance(value, dict):
            raise invalid(f"must be a mapping with a 'kind' ({kinds}), not {shortened(value)}")
        if "kind" not in value:
            raise invalid(f"has no 'kind'; give one of {kinds}")
        own = keys.get(str(value["kind"]), [*value])  # an unknown kind accepts any key
        unknown = {}
        for key in value:
            others = [kind for kind, names in keys.items() if key in names]
            if key not in own and others:  # true only for a known kind
                meant = parts[str(value["kind"])].synonyms.get(str(key))
                hint = f"; did you mean {meant!r}?" if meant else f"; it is a key of {', '.join(others)}"
                unknown[key] = f" for kind '{value['kind']}'{hint}"
        return without_unknown_keys(value, unknown, validate)

    return WrapValidator(read)
