"""Campaign as written in YAML: the scenario, the number of cases, and what is varied and kept."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import BeforeValidator, Field, PrivateAttr, ValidationError, model_validator

from onorbit_rs.campaigns.distributions import Change, Quantity
from onorbit_rs.campaigns.draws import Sampling
from onorbit_rs.scenario.errors import invalid, shortened
from onorbit_rs.scenario.fields import Positive, Time, Whole
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.validation_errors import first_error
from onorbit_rs.scenario.yaml_lines import Lines

MOST_CASES = 10**7


class Keep(Part):
    """Results of every case that are kept in addition to its summary."""

    synonyms: ClassVar = {"rate": "every", "period": "every", "failed": "failures"}

    columns: list[str] = Field(default_factory=list)
    """Columns of the trace, as named in ``trace.npz``; they are written to ``columns.parquet``."""
    every: Annotated[Time, Positive] | None = None
    """Interval between two rows of ``columns``, s. Default: every recorded row."""
    failures: Literal["summary", "full"] = "summary"
    """``summary``, or ``full``, which also writes the folder of an ordinary run, with figures and recording,
    for every case without success."""

    @model_validator(mode="before")
    @classmethod
    def _from_word(cls, value: Any) -> Any:
        if value == "summary":
            return {}
        if not isinstance(value, dict) and not isinstance(value, Part):
            raise invalid(
                f"must be 'summary', or a mapping with 'columns', 'every' and 'failures', not "
                f"{shortened(value)}"
            )
        return value

    @model_validator(mode="after")
    def _has_columns(self) -> Self:
        if self.every is not None and not self.columns:
            raise invalid("'every' applies to 'columns'; name at least one column, or omit 'every'")
        return self


class Condition(Part):
    """Limits for one value of a case, all of which must hold; a missing value does not satisfy them."""

    synonyms: ClassVar = {
        "max": "at_most", "min": "at_least", "less_than": "below", "more_than": "above", "is": "equals",
    }  # fmt: skip

    at_most: Quantity | None = None
    at_least: Quantity | None = None
    below: Quantity | None = None
    above: Quantity | None = None
    equals: Any = None

    @model_validator(mode="after")
    def _is_any(self) -> Self:
        if not self.model_fields_set:
            raise invalid(f"has no limit; give at least one of {', '.join(self.yaml_keys())}")
        return self

    def holds(self, value: Any) -> bool:
        """Return True if a value satisfies all limits; None is a missing value."""
        if value is None:
            return False
        if "equals" in self.model_fields_set and value != self.equals:
            return False
        limits = (self.at_most, self.at_least, self.below, self.above)
        if all(limit is None for limit in limits):
            return True
        if isinstance(value, str):
            return False
        number = float(value)
        return (
            (self.at_most is None or number <= self.at_most)
            and (self.at_least is None or number >= self.at_least)
            and (self.below is None or number < self.below)
            and (self.above is None or number > self.above)
        )


def _source(value: Any) -> Any:
    if isinstance(value, (str, dict)) and value:
        return value
    raise invalid(f"must be a bundled name, a YAML file or a whole scenario, not {shortened(value)}")


class Campaign(Part):
    """Many runs of one scenario with dispersed values."""

    synonyms: ClassVar = {
        "runs": "cases", "samples": "cases", "n": "cases", "method": "sampling", "dispersions": "vary",
        "disperse": "vary", "variations": "vary", "random_seed": "seed",
    }  # fmt: skip

    scenario: Annotated[Any, BeforeValidator(_source)]
    """Nominal scenario: a bundled name, a YAML file relative to the campaign file, or its whole content."""
    cases: Whole = Field(ge=1, le=MOST_CASES)
    """Number of cases."""
    seed: Whole = Field(default=0, ge=0, le=2**63)
    """Seed of the random numbers."""
    sampling: Sampling = "random"
    """Method that draws the random numbers: ``random``, ``latin_hypercube`` or ``sobol``."""
    vary: Annotated[dict[str, Change], Field(min_length=1)]
    """Changes of entries of the scenario; the keys are the paths of the entries."""
    keep: Keep = Field(default_factory=Keep)
    """``summary``, or a mapping with further results to keep for every case."""
    success: dict[str, Condition] = Field(default_factory=dict)
    """Conditions on columns of ``cases.parquet``, by the name of the column. A case is a success if it is
    complete, its certificate passed, and all conditions hold."""


class CampaignDocument(Part):
    """Content of a campaign file."""

    name: str = "campaign"
    """Name in results and messages. Default: the name of the file."""
    description: str = ""
    """Description in one sentence, for lists and the report."""
    campaign: Campaign

    _file: Path | None = PrivateAttr(default=None)
    _lines: Lines = PrivateAttr(default_factory=dict)

    @classmethod
    def checked(cls, data: dict[str, Any], file: Path | None, lines: Lines) -> CampaignDocument:
        """Return a validated campaign; raise ScenarioError with the location of an invalid entry."""
        named = data if file is None or "name" in data else data | {"name": file.stem}
        try:
            document = cls.model_validate(named)
        except ValidationError as error:
            raise first_error(error, named, file, lines) from None
        document._file, document._lines = file, lines
        return document

    @property
    def file(self) -> Path | None:
        """YAML file of the campaign; None for a campaign created in Python."""
        return self._file

    @property
    def lines(self) -> Lines:
        """Line number of every entry of the file, by the location of the entry."""
        return self._lines
