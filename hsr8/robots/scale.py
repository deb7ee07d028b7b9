"""Scale of a robot relative to HSR-VIII, by which quantities of the world and the walk scale.

A parameter or key with such a quantity has its unit in its annotation: ``Annotated[float, "m/s"]``.
Quantities without one are equal for all robots: angles, ratios, pixels, and sensors.

A length scales with the legs, a velocity with the speed limits of navigation, and a time with
length / speed, so that a scaled robot meets the same situations in scaled time.
"""

import re
from dataclasses import dataclass, field
from typing import Any

DEFAULT_ROBOT = "hsr8"
"""Robot that all defaults were tuned for."""
DEFAULT_STATURE = 0.487
"""Height of the standing default robot [m]."""

DEFAULT_FOV_DEG = 46.8
"""Vertical field of view of the default camera; 60 deg horizontally at 4:3 [deg]."""

_POWER = re.compile(r"(m|s|rad|N)(?:\^(\d+(?:\.\d+)?)|(²))?")
# Exponents of length, speed, turn and weight. A force is a fraction of the weight per time of a
# falling pendulum, √(length / g), so that N s is an impulse with an equal effect on the balance.
_BASE = {
    "m": (1.0, 0.0, 0.0, 0.0),
    "s": (1.0, -1.0, 0.0, 0.0),
    "rad": (1.0, -1.0, 1.0, 0.0),
    "N": (-0.5, 1.0, 0.0, 1.0),
}


@dataclass(frozen=True, slots=True)
class RobotScale:
    """Ratios of a robot to HSR-VIII.

    Attributes:
        length: ratio of the lengths of the legs [1].
        speed: ratio of the forward speed limits of navigation [1].
        turn: ratio of the turn rate limits of navigation [1].
        weight: ratio of the weights [1].
    """

    length: float = 1.0
    speed: float = 1.0
    turn: float = 1.0
    weight: float = 1.0

    @property
    def time(self) -> float:
        """Ratio of times [1]."""
        return self.length / self.speed

    def factor(self, unit: str) -> float:
        """Return the ratio of quantities in some unit.

        Args:
            unit: product of powers of m, s, rad and N over another one, such as ``m/s``, ``m²/s``,
                ``m/s^1.5``, ``1/m``, ``rad/s`` or ``N s``.

        Raises:
            ValueError: the unit is not of that form.
        """
        ratios = (self.length, self.speed, self.turn, self.weight)
        factor = 1.0
        for ratio, exponent in zip(ratios, _exponents(unit), strict=True):
            factor *= ratio**exponent
        return factor


@dataclass(frozen=True)
class RobotDefaults:
    """Defaults of a scenario that depend on the robot.

    Attributes:
        scale: scale of all other defaults and of the built-in scenarios.
        table: keys of a scenario in nested tables, with their defaults.
    """

    scale: RobotScale = RobotScale()
    table: dict[str, Any] = field(default_factory=dict)


def _exponents(unit: str) -> tuple[float, ...]:
    """Return the exponents of length, speed, turn and weight of a unit."""
    above, over, below = unit.partition("/")
    parts = [] if over and above == "1" else [(part, 1.0) for part in above.split(" ")]
    parts += [(part, -1.0) for part in below.split(" ")] if over else []
    total = [0.0] * 4
    for part, sign in parts:
        power = _POWER.fullmatch(part)
        if power is None:
            raise ValueError(f"unit {unit!r}: expected powers of m, s, rad and N, such as m/s")
        name, exponent, squared = power.groups()
        times = sign * (float(exponent) if exponent else 2.0 if squared else 1.0)
        total = [a + times * b for a, b in zip(total, _BASE[name], strict=True)]
    return tuple(total)
