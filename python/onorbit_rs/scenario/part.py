"""What every part of a scenario shares: unknown keys are refused, naming the nearest right one."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, ConfigDict, model_validator
from pydantic_core import PydanticCustomError

from onorbit_rs.names import did_you_mean


class Part(BaseModel):
    """A mapping in the YAML."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)

    @model_validator(mode="before")
    @classmethod
    def _refuse_unknown_keys(cls, value: Any) -> Any:
        if isinstance(value, dict):
            known = [field.alias or name for name, field in cls.model_fields.items()]
            for key in value:
                if key not in known:
                    hint = did_you_mean(str(key), known) or f", known are: {', '.join(known)}"
                    raise PydanticCustomError("unknown_key", "unknown key{hint}", {"key": key, "hint": hint})
        return value


def expand_kind(value: Any) -> Any:
    """``gravity_gradient`` alone means ``{kind: gravity_gradient}``."""
    return {"kind": value} if isinstance(value, str) else value
