"""How parameters scale with the robot: dynamic similarity.

A parameter that is a length grows with the legs, one that is a time with the period of the
pendulum. Such powers of the robot's own measures are all that it takes to carry a choice that
was made for one robot over to another: the walk of a robot of twice the size is then the same
walk in longer steps and slower time (with gravity the same, equal Froude numbers v²/(g leg);
Alexander, "Optimization and gaits in the locomotion of vertebrates", Physiol. Rev. 1989).
"""

from __future__ import annotations

from dataclasses import dataclass

from walking.robot_measures import RobotMeasures


@dataclass(frozen=True, slots=True)
class Dimension:
    """A product of powers of a robot's measures, see `RobotMeasures`.

    Attributes:
        leg, hip, sole, time, weight, ankle: the powers.
    """

    leg: float = 0.0
    hip: float = 0.0
    sole: float = 0.0
    time: float = 0.0
    weight: float = 0.0
    ankle: float = 0.0

    def __mul__(self, other: Dimension) -> Dimension:
        return Dimension(*(a + b for a, b in zip(self._powers, other._powers, strict=True)))

    def __truediv__(self, other: Dimension) -> Dimension:
        return self * other**-1.0

    def __pow__(self, power: float) -> Dimension:
        return Dimension(*(power * a for a in self._powers))

    @property
    def _powers(self) -> tuple[float, ...]:
        return self.leg, self.hip, self.sole, self.time, self.weight, self.ankle

    def scale(self, value: float, old: RobotMeasures, new: RobotMeasures) -> float:
        """What `value` of the robot with measures `old` is for one with measures `new`."""
        factor = 1.0
        for power, a, b in zip(self._powers, old.values(), new.values(), strict=True):
            factor *= (b / a) ** power
        return value * factor


@dataclass(frozen=True, slots=True)
class DecayPerTick:
    """A share of something that is left after a control tick, as of an exponential decay."""

    def scale(self, value: float, old: RobotMeasures, new: RobotMeasures) -> float:
        """The share that leaves as much after the same phase of the gait."""
        return float(value ** (old.time / new.time))


@dataclass(frozen=True, slots=True)
class GainPerTick:
    """A share of a difference that is made up for in a control tick."""

    def scale(self, value: float, old: RobotMeasures, new: RobotMeasures) -> float:
        """The share that makes up for as much in the same phase of the gait."""
        if old.time == new.time:
            return value  # not even rounded
        return 1.0 - DecayPerTick().scale(1.0 - value, old, new)


Rule = Dimension | DecayPerTick | GainPerTick
"""How a parameter goes over to another robot."""

NUMBER = Dimension()
"""A share, a gain, an angle or a sensor's property: the same for every robot."""
LENGTH = Dimension(leg=1.0)
"""A length of the walk."""
STANCE = Dimension(hip=1.0)
"""A distance across the stance."""
SOLE = Dimension(sole=1.0)
"""A distance within the sole."""
TIME = Dimension(time=1.0)
"""A time of the walk."""
HEIGHT = TIME**2.0
"""Height of a pendulum; gravity is the same for all."""
CHANGE_WEIGHT = TIME**2.0
"""Weight of changes per control tick, that of their effect one."""
FORCE = Dimension(weight=1.0)
"""A part of the robot's weight."""
SPEED = LENGTH / TIME
"""A speed of the walk."""
SOLE_SPEED = SOLE / TIME
"""A speed within the sole."""
DIFFUSION = LENGTH / TIME**0.5
"""A random walk of so much in the square root of time."""
ACCELERATION = LENGTH / TIME**2.0
"""An acceleration of the walk."""
RATE = TIME**-1.0
"""An angular velocity, or a gain against a velocity."""
RATE_CHANGE = TIME**-2.0
"""An angular acceleration."""
ANKLE_TIME = Dimension(ankle=1.0) * TIME
"""Setpoint of an ankle per angular velocity: the softer the servo, the larger."""
PER_LENGTH = LENGTH**-1.0
"""An angle per length of the walk."""
DECAY_PER_TICK = DecayPerTick()
"""A share left after a control tick."""
GAIN_PER_TICK = GainPerTick()
"""A share made up for in a control tick."""
