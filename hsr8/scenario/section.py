"""Base class and common types of the sections of a scenario."""

from typing import Annotated, Literal

from annotated_types import Interval, MultipleOf
from pydantic import AfterValidator, BaseModel, ConfigDict

from walking.parameters import CONTROL_PERIOD

CONTROL_PERIOD_MS = round(1000.0 * CONTROL_PERIOD)


class Section(BaseModel):
    """Table of a scenario file: strict types, no unknown keys, immutable.

    The configuration also applies to the parameter dataclasses of the libraries.
    """

    model_config = ConfigDict(
        extra="forbid",
        frozen=True,
        strict=True,
        allow_inf_nan=False,
    )


def ordered(bounds: tuple[float, float]) -> tuple[float, float]:
    """Check that the first bound of a range is not above the second."""
    if bounds[0] > bounds[1]:
        raise ValueError("the first bound must not be above the second")
    return bounds


PeriodMs = Annotated[int, Interval(ge=CONTROL_PERIOD_MS, le=10_000), MultipleOf(CONTROL_PERIOD_MS)]
Count = Annotated[int, Interval(ge=0, le=64)]
Metres = Annotated[float, Interval(ge=-250.0, le=250.0), "m"]
Point = tuple[Metres, Metres]
Radius = Annotated[float, Interval(gt=0.0, le=2.0), "m"]
Speed = Annotated[float, Interval(gt=0.0, le=5.0), "m/s"]
Degrees = Annotated[float, Interval(ge=-360.0, le=360.0)]
Ratio = Annotated[float, Interval(gt=0.0, le=3.0)]
Length = Annotated[float, Interval(gt=0.0, le=100.0), "m"]
RadiusRange = Annotated[tuple[Radius, Radius], AfterValidator(ordered)]
RatioRange = Annotated[tuple[Ratio, Ratio], AfterValidator(ordered)]
LengthRange = Annotated[tuple[Length, Length], AfterValidator(ordered)]
Color = Literal["red", "green", "blue", "violet"]
