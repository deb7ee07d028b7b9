"""What all sections of a scenario share: strict reading, units in words, common ranges."""

from typing import Annotated, Literal

from annotated_types import Interval, MultipleOf
from pydantic import AfterValidator, BaseModel, ConfigDict

from walking.parameters import CONTROL_PERIOD

CONTROL_PERIOD_MS = round(1000.0 * CONTROL_PERIOD)


class Section(BaseModel):
    """A table of a scenario file: no unknown keys, no guessed types, no changes afterwards.

    The parameter dataclasses of the libraries are sections too: pydantic reads their
    constraints, `hsr8.docstrings` the docstrings of attributes, and these settings hold for
    them as well.
    """

    model_config = ConfigDict(
        extra="forbid",
        frozen=True,
        strict=True,
        allow_inf_nan=False,
    )


def ordered(bounds: tuple[float, float]) -> tuple[float, float]:
    """Refuse a range whose first bound is the greater."""
    if bounds[0] > bounds[1]:
        raise ValueError("the smaller bound comes first")
    return bounds


PeriodMs = Annotated[int, Interval(ge=CONTROL_PERIOD_MS, le=10_000), MultipleOf(CONTROL_PERIOD_MS)]
Count = Annotated[int, Interval(ge=0, le=64)]
Metres = Annotated[float, Interval(ge=-50.0, le=50.0)]
Point = tuple[Metres, Metres]
Radius = Annotated[float, Interval(gt=0.0, le=0.5)]
Speed = Annotated[float, Interval(gt=0.0, le=2.0)]
Degrees = Annotated[float, Interval(ge=-360.0, le=360.0)]
Ratio = Annotated[float, Interval(gt=0.0, le=3.0)]
Length = Annotated[float, Interval(gt=0.0, le=20.0)]
RadiusRange = Annotated[tuple[Radius, Radius], AfterValidator(ordered)]
RatioRange = Annotated[tuple[Ratio, Ratio], AfterValidator(ordered)]
LengthRange = Annotated[tuple[Length, Length], AfterValidator(ordered)]
Color = Literal["red", "green", "blue", "violet"]
