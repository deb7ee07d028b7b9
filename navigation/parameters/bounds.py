"""Bounds that many parameters share."""

from typing import Annotated

from annotated_types import Interval

Positive = Annotated[float, Interval(ge=0.001, le=1000.0)]
NonNegative = Annotated[float, Interval(ge=0.0, le=1000.0)]
