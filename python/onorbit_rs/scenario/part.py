"""What every part of a scenario shares: unknown keys are refused, naming the nearest right one."""

from __future__ import annotations

from typing import Any, ClassVar, get_args

from pydantic import BaseModel, BeforeValidator, ConfigDict, model_validator

from onorbit_rs.names import nearest
from onorbit_rs.scenario.refusals import shown, unknown_key, wrong

FEW = 8
"""Keys that are listed beside the nearest one."""


class Part(BaseModel):
    """A mapping in the YAML."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)

    other_words: ClassVar[dict[str, str]] = {}
    """What people call a key, and what it is called here."""

    @classmethod
    def yaml_keys(cls) -> list[str]:
        """Those it may have, as the YAML writes them."""
        return [field.alias or name for name, field in cls.model_fields.items()]

    @model_validator(mode="before")
    @classmethod
    def _refuse_unknown_keys(cls, value: Any) -> Any:
        if isinstance(value, dict):
            known = cls.yaml_keys()
            for key in value:
                if key not in known:
                    raise unknown_key(
                        str(key), cls._hint(str(key), [name for name in known if name not in value])
                    )
        return value

    @classmethod
    def _hint(cls, key: str, free: list[str]) -> str:
        """The key that was meant: one that is not given yet."""
        near = cls.other_words.get(key.lower()) or nearest(key, free)
        known = [name for name in cls.yaml_keys() if name != "kind"]
        hint = f", did you mean {near!r}?" if near else ""
        if hint and len(known) > FEW:
            return hint
        return f"{hint}{' ' if hint else ', '}known are: {', '.join(known)}" if known else "; it has none"


def of_kind(union: Any) -> BeforeValidator:
    """Before a union of parts, each with its ``kind``: a word alone is a kind, and complaints name the kinds.

    ``gravity_gradient`` means ``{kind: gravity_gradient}``.
    """
    parts = {get_args(part.model_fields["kind"].annotation)[0]: part for part in get_args(union)}
    keys = {kind: part.yaml_keys() for kind, part in parts.items()}
    kinds = ", ".join(keys)

    def read(value: Any) -> Any:
        value = {"kind": value} if isinstance(value, str) else value
        if isinstance(value, Part):
            return value
        if not isinstance(value, dict):
            raise wrong(f"must be a mapping with a 'kind' ({kinds}), not {shown(value)}")
        if "kind" not in value:
            raise wrong(f"needs a 'kind': {kinds}")
        own = keys.get(str(value["kind"]), [*value])  # of an unknown kind nothing is known
        for key in value:
            others = [kind for kind, theirs in keys.items() if key in theirs]
            if key not in own and others:  # so the kind is known
                meant = parts[str(value["kind"])].other_words.get(str(key))
                way_out = f", did you mean {meant!r}?" if meant else f"; it belongs to {', '.join(others)}"
                raise unknown_key(key, f" of kind '{value['kind']}'{way_out}")
        return value

    return BeforeValidator(read)
