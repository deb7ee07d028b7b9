"""Bounds that many parameters share."""

from math import pi
from typing import Annotated

from annotated_types import Ge, Gt, Le, Len

Positive = Annotated[float, Gt(0.0)]
NonNegative = Annotated[float, Ge(0.0)]
Share = Annotated[float, Ge(0.0), Le(1.0)]
Count = Annotated[int, Ge(1)]
Angle = Annotated[float, Gt(0.0), Le(pi)]
Rings = Annotated[tuple[Positive, ...], Len(1, 20)]
