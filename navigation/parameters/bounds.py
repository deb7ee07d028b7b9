"""Bounds that many parameters share."""

from typing import Annotated

from annotated_types import Ge, Gt

Positive = Annotated[float, Gt(0.0)]
NonNegative = Annotated[float, Ge(0.0)]
